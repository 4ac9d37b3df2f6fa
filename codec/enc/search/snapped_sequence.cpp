#include "codec/enc/search/snapped_sequence.h"

#include <algorithm>
#include <cmath>

#include "codec/common/lossless/number_set.h"
#include "codec/enc/lossless/lossless_sequence.h"
#include "codec/enc/search/error_sums.h"
#include "codec/enc/search/sequence_summary.h"

namespace reeb {

namespace {

// Of twice the bound: leaves room for rounding a multiple to binary32.
constexpr double kStepShare = 1 - 1.0 / 1024;

/// Moves each coordinate to the multiple next to it; those that it would miss stay.
void snap(Shot& shot, const NumberSet& multiples, double bound) {
  for (float& x : shot.positions) {
    const int64_t n = multiples.nearest(static_cast<double>(x));
    if (!multiples.valid(n)) continue;
    const float y = multiples.number(n);
    if (std::abs(static_cast<double>(y) - static_cast<double>(x)) < bound) x = y;
  }
}

}  // namespace

Status encode_snapped(const Sequence& sequence, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats) {
  const double step = 2 * options.target_value * kStepShare;
  const NumberSet multiples = NumberSet::multiples(step);
  Sequence snapped = sequence;
  ErrorSums errors;
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    const Shot& shot = sequence.shots[i];
    snap(snapped.shots[i], multiples, options.target_value);
    for (uint32_t t = 0; t < shot.frame_count; ++t)
      errors.add(shot.frame(t), snapped.shots[i].frame(t));
  }
  if (Status s = encode_lossless(snapped, options, {.step = step, .face_order = false}, out, stats);
      !s.ok())
    return s;
  stats.kg = kg_error(errors.squared, energy_of(sequence));
  stats.rmse = std::sqrt(errors.squared / vertex_frames_of(sequence));
  stats.max_error = errors.largest;
  return {};
}

}  // namespace reeb
