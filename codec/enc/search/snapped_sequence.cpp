#include "codec/enc/search/snapped_sequence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "codec/common/lossless/number_set.h"
#include "codec/enc/lossless/lossless_sequence.h"
#include "codec/enc/search/sequence_summary.h"

namespace reeb {

namespace {

// Of twice the bound: leaves room for rounding a multiple to binary32.
constexpr double kStepShare = 1 - 1.0 / 1024;

struct ErrorFigures {
  double squared = 0;  ///< sum over all coordinates
  double energy = 0;   ///< of the original about the mean of each frame and axis
  double largest = 0;
};

/// Moves each coordinate to the multiple next to it; those that it would miss stay.
void snap(Shot& shot, const NumberSet& multiples, double bound) {
  for (float& x : shot.positions) {
    const int64_t n = multiples.nearest(static_cast<double>(x));
    if (!multiples.valid(n)) continue;
    const float y = multiples.number(n);
    if (std::abs(static_cast<double>(y) - static_cast<double>(x)) < bound) x = y;
  }
}

void measure(std::span<const float> original, std::span<const float> snapped, ErrorFigures& out) {
  std::array<double, 3> mean{};
  for (size_t i = 0; i < original.size(); ++i) mean[i % 3] += static_cast<double>(original[i]);
  const size_t vertices = original.size() / 3;
  for (double& m : mean) m /= static_cast<double>(vertices);
  for (size_t i = 0; i < original.size(); ++i) {
    const auto x = static_cast<double>(original[i]);
    const double error = std::abs(x - static_cast<double>(snapped[i]));
    out.squared += error * error;
    out.largest = std::max(out.largest, error);
    out.energy += (x - mean[i % 3]) * (x - mean[i % 3]);
  }
}

}  // namespace

Status encode_snapped(const Sequence& sequence, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats) {
  const double step = 2 * options.target_value * kStepShare;
  const NumberSet multiples = NumberSet::multiples(step);
  Sequence snapped = sequence;
  ErrorFigures errors;
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    const Shot& shot = sequence.shots[i];
    snap(snapped.shots[i], multiples, options.target_value);
    for (uint32_t t = 0; t < shot.frame_count; ++t)
      measure(shot.frame(t), snapped.shots[i].frame(t), errors);
  }
  if (Status s = encode_lossless(snapped, options, step, out, stats); !s.ok()) return s;
  stats.kg = errors.energy > 0 ? 100 * std::sqrt(errors.squared / errors.energy) : 0;
  stats.rmse = std::sqrt(errors.squared / vertex_frames_of(sequence));
  stats.max_error = errors.largest;
  return {};
}

}  // namespace reeb
