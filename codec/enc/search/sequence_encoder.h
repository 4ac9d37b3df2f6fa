// Encoder of a whole sequence: the search for the cheapest stream that meets the target.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bitstream/status.h"
#include "codec/enc/encoder.h"
#include "codec/enc/search/effort.h"
#include "codec/enc/search/shot_encoder.h"

namespace reeb {

/// One encoding of the whole sequence with one quantization step.
struct Attempt {
  std::vector<ShotSettings> settings;  ///< of each shot
  double q = 0;
  std::vector<CodedShot> shots;
  std::vector<uint8_t> bytes;  ///< the file
  double squared_error = 0;    ///< over all vertices, frames and axes
  double excess = 0;           ///< ln(measured / wanted): above 0 the target is missed
};

class SequenceEncoder {
 public:
  /// `sequence` must outlive the encoder and satisfy the pre-conditions of `encode`.
  SequenceEncoder(const Sequence& sequence, const EncodeOptions& options)
      : SequenceEncoder(sequence, sequence, options) {}
  /// `base` is coded where corrections lead from it to `sequence`: Target::kMaxError.
  SequenceEncoder(const Sequence& sequence, const Sequence& base, const EncodeOptions& options);

  /// `missed`: the target is out of reach; `stats` are then those of the nearest.
  Status run(std::vector<uint8_t>& out, EncodeStats& stats, bool& missed);

 private:
  using Settings = std::vector<ShotSettings>;

  Settings first_settings() const;
  /// The settings with reference grids that suit an RMS error of `error` per coordinate.
  Settings with_grids(Settings settings, double error) const;
  Status attempt(const Settings& settings, double q, Attempt& out);
  /// Makes the reference meshes that `expect` counts on.
  Status prepare(const Settings& settings);
  double kg_of(double squared_error) const;
  double bytes_per_unit() const;  ///< of the target, a size
  double excess_of(const Attempt& a) const;
  ErrorSums measure(const Attempt& a) const;
  EncodeStats stats() const;

  /// From `best_` on, finds the step that meets the target with its settings: ln(measured / wanted)
  /// within [slack - tolerance, slack]. The result is in `best_`.
  Status search(double slack, double tolerance, int max_trials);
  /// The last search, for real.
  Status finish_search();
  /// True where it is within the tolerance below the target.
  bool meets(const Attempt& a) const;
  /// Tries steps next to that of `best_`, which meets the target, and keeps the best of all.
  Status polish();
  /// Keeps the numbers of components of `best_`, or lets them go.
  void hold_components(bool held);
  /// Bits and squared error to expect.
  RatePoint expect(const Settings& settings, double q) const;
  /// |d ln(measured) / d ln q| to expect; 0 where there is nothing to go by.
  double expected_slope(const Settings& settings, double q) const;
  /// Step at which the target is to be expected.
  double guess_step(const Settings& settings) const;
  /// Error of a coordinate that the target makes likely, before anything is known of the motion.
  double first_error() const;
  /// The first attempt.
  Status start();
  /// Sets the grids for the error of `best_`, and makes that anew where they changed.
  Status suit_grids();
  /// Target::kMaxError: finds the step that makes the smallest file.
  Status search_base();
  bool bounded() const { return options_.target == Target::kMaxError; }
  Status refine_grids();
  Status choose_meshes();
  bool regions_may_pay() const;
  Status choose_regions();
  Status choose_prior();
  /// Tries settings at the step of `best_`, and keeps them there where they pay.
  Status try_settings(const Settings& settings, bool& kept);

  double coordinate_error() const;
  double least_step() const;
  bool advance(double part);

  const Sequence& sequence_;
  const EncodeOptions& options_;
  const EffortPreset& effort_;
  const ProfileTools& tools_;
  std::vector<std::unique_ptr<ShotEncoder>> shots_;
  double energy_ = 0;  ///< of the base
  double vertex_frames_ = 0;
  Attempt best_;
  double done_ = 0;
  bool exact_ = false;  ///< measure the KG error on positions instead of by the normal equations
};

}  // namespace reeb
