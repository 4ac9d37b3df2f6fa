#include "codec/enc/fields/field_encoder.h"

#include <algorithm>
#include <cmath>

#include "codec/common/base/coding_tools.h"

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
    : field_(field), lambda_(uses(coding_tool::kRdo) ? lambda : 0) {
  for (const uint8_t level : graph.step_level)
    importance_.push_back(std::exp2(mass_exponent * level / 8.0));
}

int64_t FieldEncoder::decide(double residual, double step, double importance,
                             MagnitudeModel::Bins& bins) const {
  constexpr auto kLargest = MagnitudeModel::kMaxMagnitude / 2;
  const double size = std::min(std::abs(residual) / step, static_cast<double>(kLargest));
  const uint64_t nearest = MagnitudeModel::representable(static_cast<uint64_t>(size + 0.5));
  uint64_t best = nearest;
  if (nearest > 0 && nearest < MagnitudeModel::kEscapeBegin) {
    double best_cost = 1e300;
    const auto consider = [&](uint32_t n) {
      const double error = (size - n) * step;
      const double cost = error * error * importance + lambda_ * magnitude_bits(bins, n);
      if (cost < best_cost) {
        best_cost = cost;
        best = n;
      }
    };
    consider(static_cast<uint32_t>(nearest));
    consider(static_cast<uint32_t>(nearest) - 1);
    if (nearest > 1) consider(0);
  }
  return residual < 0 ? -static_cast<int64_t>(best) : static_cast<int64_t>(best);
}

double FieldEncoder::code_component(const float* target) {
  const auto quantize = [&](uint32_t row, float prediction, uint32_t step,
                            MagnitudeModel::Bins& bins) {
    const double residual = static_cast<double>(target[row]) - static_cast<double>(prediction);
    const int64_t n = decide(residual, step / 65536.0, importance_[row], bins);
    return field_.model().code(recorder_, bins, n);
  };
  field_.code_component(quantize);
  const std::vector<float>& plane = field_.plane(field_.component_count() - 1);
  double error = 0;
  for (size_t row = 0; row < plane.size(); ++row) {
    const double d = static_cast<double>(plane[row]) - static_cast<double>(target[row]);
    error += d * d;
  }
  return error;
}

}  // namespace reeb
