#include "codec/enc/fields/correction_encoder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "codec/common/base/largest_magnitude.h"
#include "codec/common/synthesis/correction_field.h"
#include "entropy/range_coder.h"

namespace reeb {

namespace {

constexpr double kMaxSteps = 9007199254740991.0;  // 2^53 - 1

/// Chooses the correction of single coordinates.
class Corrector {
 public:
  /// `largest`: the largest magnitude of what is corrected. Coordinates that are far from it may be
  /// larger, and are replaced.
  Corrector(double bound, float largest) : bound_(bound), step_(bound) {
    // Twice the bound is enough, but for the rounding of the corrected value to binary32.
    const float next = std::nextafter(largest, std::numeric_limits<float>::infinity());
    const double rounding = static_cast<double>(next) - static_cast<double>(largest);
    if (bound > 4 * rounding) step_ = 2 * (bound - rounding);
  }

  double step() const { return step_; }

  Correction choose(float original, float base) const {
    if (within(original, base)) return {};
    const double distance = static_cast<double>(original) - static_cast<double>(base);
    const double steps = std::nearbyint(distance / step_);
    for (const double candidate : {steps, steps - 1, steps + 1}) {
      if (!(std::abs(candidate) <= kMaxSteps)) continue;
      const Correction c{static_cast<int64_t>(candidate), false, 0};
      if (within(original, c.apply(base, step_))) return c;
    }
    return {0, true, original};
  }

 private:
  /// The difference is rounded to binary64, monotonically: below the bound it is not above it.
  bool within(float original, float decoded) const {
    return original == decoded ||
           std::abs(static_cast<double>(original) - static_cast<double>(decoded)) < bound_;
  }

  double bound_;
  double step_;
};

/// Positions of the base, [vertex][frame][axis].
std::vector<float> decode_vertices(const GroupSynthesis& base, uint32_t vertices) {
  const uint32_t frames = base.frame_count();
  std::vector<float> out(size_t{vertices} * frames * 3);
  base.frames(0, frames, out.data(), 3, size_t{3} * frames);
  return out;
}

}  // namespace

CodedCorrections encode_corrections(const GroupSynthesis& base, std::span<const float> original,
                                    const SurfaceContext& surface, double bound) {
  const uint32_t frames = base.frame_count();
  const size_t frame_size = size_t{surface.rows()} * 3;
  const std::vector<float> decoded = decode_vertices(base, surface.rows());
  const Corrector corrector(bound, largest_magnitude(decoded));
  CodedCorrections out;
  out.step = corrector.step();
  out.corrections = Corrections(frames, out.step);
  BinaryEncoder encoder;
  CorrectionField field(surface.surface.graph, frames);
  const auto get = [&](uint32_t row, uint32_t t, uint32_t axis) {
    const size_t vertex = surface.input[row];
    return corrector.choose(original[frame_size * t + vertex * 3 + axis],
                            decoded[(vertex * frames + t) * 3 + axis]);
  };
  field.code(encoder, get, [&](uint32_t row, uint32_t t, uint32_t axis, const Correction& c) {
    out.corrections.add(surface.input[row], t, axis, c);
    ++out.count;
    return true;
  });
  if (out.count > 0) out.bytes = encoder.finish();
  return out;
}

}  // namespace reeb
