#include "codec/enc/fields/field_encoder.h"

#include <algorithm>
#include <cmath>

#include "codec/common/base/coding_tools.h"
#include "codec/enc/fields/quantization.h"

namespace reeb {

namespace {

/// Bits of a magnitude in one of the kBins buckets.
double magnitude_bits(MagnitudeModel::Bins& bins, uint32_t magnitude) {
  const uint32_t b = MagnitudeBuckets::of(magnitude);
  double bits = MagnitudeBuckets::extra_bits(b) + (magnitude > 0 ? 1 : 0);
  bins.find([&](uint32_t node, uint32_t than) {
    const Probability p1 = bins.p1(node);
    bits += cost_of(b > than ? p1 : static_cast<Probability>(65536 - p1));
    return b > than;
  });
  return bits;
}

}  // namespace

FieldEncoder::FieldEncoder(Field& field, const PredictionGraph& graph, double lambda,
                           double mass_exponent)
    : field_(field),
      lambda_(uses(coding_tool::kRdo) ? lambda : 0),
      importance_(row_importance(graph, mass_exponent)) {}

int64_t FieldEncoder::decide(double residual, double step, double importance,
                             MagnitudeModel::Bins& bins) const {
  constexpr auto kMaxSize = MagnitudeModel::kMaxMagnitude / 2;
  const double size = std::min(std::abs(residual) / step, static_cast<double>(kMaxSize));
  uint64_t n = MagnitudeModel::representable(static_cast<uint64_t>(size + 0.5));
  if (n > 0 && n < MagnitudeModel::kEscapeBegin) {
    n = cheapest_magnitude(size, static_cast<uint32_t>(n), step, importance, lambda_,
                           [&](uint32_t m) { return magnitude_bits(bins, m); });
  }
  return residual < 0 ? -static_cast<int64_t>(n) : static_cast<int64_t>(n);
}

double FieldEncoder::code_component(const float* target) {
  const auto quantize = [&](uint32_t row, float prediction, uint32_t step,
                            MagnitudeModel::Bins& bins) {
    const double residual = static_cast<double>(target[row]) - static_cast<double>(prediction);
    const int64_t n = decide(residual, step / 65536.0, importance_[row], bins);
    return field_.model().code(recorder_, bins, n);
  };
  field_.code_component(quantize);
  return squared_error(field_.plane(field_.component_count() - 1), target);
}

}  // namespace reeb
