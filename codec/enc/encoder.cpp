#include "codec/enc/encoder.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "bitstream/chunk.h"
#include "bitstream/headers.h"
#include "codec/common/base/float_state.h"
#include "codec/common/base/largest_magnitude.h"
#include "codec/common/base/parallel.h"
#include "codec/enc/attributes/attach.h"
#include "codec/enc/lossless/lossless_sequence.h"
#include "codec/enc/search/group_plan.h"
#include "codec/enc/search/lossless_offer.h"
#include "codec/enc/search/outliers.h"
#include "codec/enc/search/profile_tools.h"
#include "codec/enc/search/sequence_encoder.h"
#include "codec/enc/search/sequence_summary.h"
#include "codec/enc/search/snapped_sequence.h"

namespace reeb {

namespace {

constexpr float kMaxPosition = 1e36f;  ///< leaves room for sums and differences in binary32

Status check_shot(const Shot& shot, bool lossless, size_t index) {
  const std::string name = "shot " + std::to_string(index + 1);
  const Connectivity& c = shot.connectivity;
  if (c.vertex_count == 0 || shot.frame_count == 0) return Status::invalid(name + " is empty");
  if (shot.positions.size() != size_t{c.vertex_count} * 3 * shot.frame_count) {
    return Status::invalid(name + ": the number of positions does not match");
  }
  for (const float x : shot.positions) {
    if (!std::isfinite(x)) return Status::invalid(name + " has a position that is not finite");
    if (!lossless && std::abs(x) > kMaxPosition) {
      return Status::invalid(name + " has a position beyond 1e36; scale the input down");
    }
  }
  return {};
}

Status check(const Sequence& sequence, const EncodeOptions& options) {
  if (sequence.shots.empty()) return Status::invalid("there is nothing to encode");
  const bool lossless = options.target == Target::kLossless;
  if (!(options.target_value > 0 || (is_error(options.target) && options.target_value == 0)) ||
      !std::isfinite(options.target_value)) {
    return Status::invalid("the target must be a number above 0, or an error of 0");
  }
  if (options.group_length > kMaxGroupFrames) return Status::invalid("group_length is above 65536");
  if (options.effort < kMinEffort || options.effort > kMaxEffort) {
    return Status::invalid("effort is not within 1 to 9");
  }
  if (options.open_groups > static_cast<int>(kMaxOpenGroups))
    return Status::invalid("open_groups is above 63");
  if (options.profile == Profile::kLossless && !lossless)
    return Status::invalid("the lossless profile has no target but Target::kLossless");
  if (options.open_groups > 0 && !lossless && !tools_of(options.profile).open_groups) {
    return Status::invalid("open_groups needs the main profile");
  }
  if (options.regions > 1024) return Status::invalid("regions is above 1024");
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    if (Status s = check_shot(sequence.shots[i], lossless, i); !s.ok()) return s;
  }
  return check_attributes(sequence);
}

/// Keeps the smaller of a corrected encoding, which is in `out`, and a snapped one.
Status try_snapped(const Sequence& sequence, const EncodeOptions& options,
                   std::vector<uint8_t>& out, EncodeStats& stats) {
  constexpr double kMinRate = 1.5;  // bits per vertex and frame: below, snapping does not pay
  const double step = 2 * options.target_value;
  if (stats.bpvf < kMinRate || !(step < static_cast<double>(kMaxPosition))) return {};
  std::vector<uint8_t> other;
  EncodeStats other_stats;
  if (Status s = encode_snapped(sequence, options, other, other_stats); !s.ok()) return s;
  if (other.size() >= out.size()) return {};
  out = std::move(other);
  stats = std::move(other_stats);
  return {};
}

/// False where all vertices of every frame are at one place: no error is relative to that.
bool extends(const Sequence& sequence) {
  for (const Shot& shot : sequence.shots) {
    for (uint32_t t = 0; t < shot.frame_count; ++t) {
      const std::span<const float> xyz = shot.frame(t);
      for (size_t i = 3; i < xyz.size(); ++i) {
        if (xyz[i] != xyz[i % 3]) return true;
      }
    }
  }
  return false;
}

/// An error so far below the precision of binary32 that nothing but a lossless coding is worth a
/// try.
bool wants_no_error(const Sequence& sequence, const EncodeOptions& options) {
  if (!is_error(options.target)) return false;
  if (!extends(sequence)) return true;
  constexpr double kPrecision = 1.0 / (1 << 30);
  if (options.target == Target::kKg) return options.target_value < 100 * kPrecision;
  float largest = 0;
  for (const Shot& shot : sequence.shots)
    largest = std::max(largest, largest_magnitude(shot.positions));
  return options.target_value <= static_cast<double>(largest) * kPrecision;
}

/// Codes with a bound on every error. `base`: without outliers, which is smaller unless they are
/// many.
Status encode_bounded(const Sequence& sequence, const Sequence& base, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats, bool& missed) {
  Status status = SequenceEncoder(sequence, base, options).run(out, stats, missed);
  if ((!status.ok() && !missed) || wants_no_error(sequence, options)) return status;
  std::vector<uint8_t> other;
  EncodeStats other_stats;
  bool other_missed = false;
  const Status other_status =
      SequenceEncoder(sequence, options).run(other, other_stats, other_missed);
  if (!other_status.ok()) return other_missed ? status : other_status;
  if (!missed && out.size() <= other.size()) return status;
  out = std::move(other);
  stats = std::move(other_stats);
  missed = false;
  return {};
}

/// Says so where errors of outliers are all that the KG error tells.
void tell_outliers(const Sequence& sequence, const Sequence& base, EncodeStats& stats) {
  constexpr double kDrowned = 100;
  if (energy_of(sequence) <= kDrowned * energy_of(base)) return;
  stats.notes.push_back(
      "some coordinates are so far from all others that errors of these hardly count for the KG "
      "error; repair them, or bound the largest error (--max-error)");
}

Status encode_lossy(const Sequence& sequence, const std::optional<Sequence>& base,
                    const EncodeOptions& options, std::vector<uint8_t>& out, EncodeStats& stats,
                    bool& missed) {
  if (base && options.target == Target::kMaxError)
    return encode_bounded(sequence, *base, options, out, stats, missed);
  Status status = SequenceEncoder(sequence, options).run(out, stats, missed);
  if (status.ok() && base) tell_outliers(sequence, *base, stats);
  return status;
}

Status encode_positions(const Sequence& sequence, const EncodeOptions& options,
                        std::vector<uint8_t>& out, EncodeStats& stats) {
  out.clear();
  stats = {};
  if (options.target == Target::kLossless)
    return encode_lossless(sequence, options, {}, out, stats);
  const std::optional<Sequence> base = without_outliers(sequence);
  bool missed = wants_no_error(base ? *base : sequence, options);
  Status status;
  if (!missed) status = encode_lossy(sequence, base, options, out, stats, missed);
  if (missed && is_error(options.target)) {
    status = encode_exactly(sequence, options, out, stats);
    stats.notes.push_back("lossless coding, since the target is out of reach with a loss");
    return status;
  }
  if (!status.ok() || !tools_of(options.profile).goes_lossless) return status;
  if (options.target == Target::kMaxError) {
    if (Status s = try_snapped(sequence, options, out, stats); !s.ok()) return s;
  }
  return offer_lossless(sequence, options, out, stats);
}

/// Bytes of one unit of a target that is a size; 0 of others.
double bytes_of_unit(const Sequence& sequence, const EncodeOptions& options) {
  if (options.target == Target::kSize) return 1;
  return options.target == Target::kBpvf ? vertex_frames_of(sequence) / 8 : 0;
}

/// The target, less what the boxes of the groups are likely to take of it.
EncodeOptions with_room_for_boxes(const Sequence& sequence, const EncodeOptions& options) {
  EncodeOptions out = options;
  const double unit = bytes_of_unit(sequence, options);
  if (!options.bounds || unit == 0) return out;
  size_t bytes = kMaxFrontBytes;
  for (const Shot& shot : sequence.shots)
    bytes += plan_groups(shot, options).lengths.size() * kBoxBytes;
  const double rest = options.target_value - static_cast<double>(bytes) / unit;
  if (rest > 0) out.target_value = rest;
  return out;
}

/// Adds attributes to what was coded with the options `less`. Where they take the file past its
/// target, positions are coded once more, for less.
Status add_attributes(const Sequence& sequence, const EncodeOptions& options, EncodeOptions less,
                      std::vector<uint8_t>& out, EncodeStats& stats) {
  constexpr int kTrials = 4;
  const double vertex_frames = vertex_frames_of(sequence);
  const double unit = bytes_of_unit(sequence, options);
  const AnimatedOptions animated = {
      .profile = options.profile == Profile::kFast ? Profile::kFast : Profile::kMain,
      .quick = options.effort <= kQuickEffort,
      .bounds = options.bounds,
      .reorder = options.reorder,
      .trials = options.effort,
      .threads = resolve_threads(options.threads)};
  for (int trial = 0;; ++trial) {
    if (Status s = attach_attributes(sequence, animated, out); !s.ok()) return s;
    const double excess = static_cast<double>(out.size()) - options.target_value * unit;
    if (unit == 0 || excess <= 0) break;
    less.target_value -= excess / unit;
    if (trial == kTrials || !(less.target_value > 0))
      return Status::invalid("the attributes leave no room for positions at this target");
    if (Status s = encode_positions(sequence, less, out, stats); !s.ok()) return s;
  }
  const EncodeStats sizes = size_stats(out, vertex_frames);
  stats.bytes = sizes.bytes;
  stats.bpvf = sizes.bpvf;
  stats.sections = sizes.sections;
  return {};
}

}  // namespace

Status encode(const Sequence& sequence, const EncodeOptions& options, std::vector<uint8_t>& out,
              EncodeStats& stats) {
  const FloatState state;
  out.clear();
  stats = {};
  if (Status s = check(sequence, options); !s.ok()) return s;
  const EncodeOptions less = with_room_for_boxes(sequence, options);
  Status status = encode_positions(sequence, less, out, stats);
  if (status.ok() && (has_attributes(sequence) || options.bounds))
    status = add_attributes(sequence, options, less, out, stats);
  if (!status.ok()) out.clear();
  return status;
}

}  // namespace reeb
