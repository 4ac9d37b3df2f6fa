// Encoder of animated meshes into `.reeb` streams.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bitstream/profile.h"
#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "codec/common/base/stop.h"

namespace reeb {

/// What the encoder aims at. Exactly one target per encoding.
enum class Target {
  kKg,        ///< KG error in percent, of the whole sequence
  kMaxError,  ///< largest error of any coordinate, in units of the input, never exceeded
  kBpvf,      ///< bits per vertex and frame, the whole file counted
  kSize,      ///< bytes of the file, never exceeded
  kLossless,  ///< every bit of every position; target_value, profile and regions do not matter
};

/// True of targets that are errors; their value may be 0, which codes without a loss.
constexpr bool is_error(Target target) {
  return target == Target::kKg || target == Target::kMaxError;
}

inline constexpr int kMinEffort = 1;
inline constexpr int kDefaultEffort = 5;
inline constexpr int kMaxEffort = 9;

struct EncodeOptions {
  Target target = Target::kKg;
  double target_value = 0.05;  ///< > 0, an error also 0; unit as the target says
  uint32_t group_length = 0;   ///< frames per group, 1 .. 65536; 0 = chosen by the encoder
  /// Groups in a row, 0 .. 63, that may continue the group before: fewer bits, but a seek decodes
  /// the whole run; main profile only. 0 = every group decodes alone; -1 = chosen with the length
  /// of groups, 0 where that is given.
  int open_groups = -1;
  bool reorder = false;  ///< drop the vertex order of the input (saves bits)
  Profile profile = Profile::kMain;
  int effort = kDefaultEffort;  ///< 1 (quickest) .. 9 (smallest): encoding time traded for rate
  int regions = -1;  ///< regions of the affine motion model; -1 = decided by rate-distortion, where
                     ///< trials are worth their time (up to effort 8: fast profile, a mesh in
                     ///< several pieces); 0 = none
  bool bounds = false;   ///< tells the box of every group, for players that cull
  unsigned threads = 0;  ///< 0 = all cores; the bytes do not depend on it
  /// Called with the done part in [0,1]; return false to cancel. May be empty.
  std::function<bool(double)> progress;
  StopToken stop = {};  ///< a request of any thread ends the encoding with kCancelled, soon
};

/// Figures of a finished encoding, of the decoded result against the input.
struct EncodeStats {
  struct Section {
    std::string name;
    double bits = 0;
  };
  uint64_t bytes = 0;
  double bpvf = 0;       ///< 8 * bytes / sum over shots of (vertices * frames)
  double kg = 0;         ///< percent
  double rmse = 0;       ///< per vertex, units of the input
  double max_error = 0;  ///< largest error of a coordinate, units of the input
  std::vector<Section> sections;
  std::vector<std::string> notes;  ///< e.g. where a new reference starts
};

/// Encodes `sequence` (at least one frame and one vertex, all values finite and, unless lossless,
/// below 1e36). Where that is smaller (main profile), or nothing else keeps the error, the coding
/// is lossless whatever the target, which a note says. On failure `out` is empty.
Status encode(const Sequence& sequence, const EncodeOptions& options, std::vector<uint8_t>& out,
              EncodeStats& stats);

}  // namespace reeb
