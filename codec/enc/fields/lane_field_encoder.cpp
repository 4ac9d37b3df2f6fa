#include "codec/enc/fields/lane_field_encoder.h"

#include <algorithm>
#include <cmath>

#include "codec/enc/fields/quantization.h"

namespace reeb {

SymbolCosts expected_costs() {
  SymbolCosts out{};
  for (uint32_t c = 0; c < kRansClasses; ++c) {
    const double mean = std::exp2(0.5 * c) / 16;  // see classify_lanes
    const double ratio = mean / (1 + mean);
    for (uint32_t s = 0; s < kRansSymbols; ++s) {
      const uint32_t b = rans_symbol_bucket(s);
      const double magnitude = RansBuckets::begin(b) + 0.5 * std::exp2(RansBuckets::extra_bits(b));
      const double bits = -std::log2(1 - ratio) - magnitude * std::log2(ratio);
      out[c][s] = static_cast<float>(s == 0 ? -std::log2(1 - ratio) : std::min(bits + 1, 30.0));
    }
  }
  return out;
}

SymbolCosts costs_of(const RansTables& tables) {
  SymbolCosts out = expected_costs();
  for (uint32_t c = 0; c < kRansClasses; ++c) {
    if (tables[c] == RansFrequencies{}) continue;
    for (uint32_t s = 0; s < kRansSymbols; ++s) {
      const double share = std::max(0.5, static_cast<double>(tables[c][s])) / (1 << kRansBits);
      out[c][s] =
          static_cast<float>(RansBuckets::extra_bits(rans_symbol_bucket(s)) - std::log2(share));
    }
  }
  return out;
}

LaneFieldEncoder::LaneFieldEncoder(LaneField& field, const PredictionGraph& graph, double lambda,
                                   double mass_exponent, const SymbolCosts& costs)
    : field_(field),
      lambda_(lambda),
      importance_(row_importance(graph, mass_exponent)),
      costs_(costs) {}

int32_t LaneFieldEncoder::decide(double residual, uint32_t cls, uint32_t row) const {
  const double step = static_cast<double>(field_.step(row));
  const double size = std::min(std::abs(residual) / step, double{kRansMaxMagnitude} - 1);
  const int32_t sign = residual < 0 ? -1 : 1;
  const uint32_t n = cheapest_magnitude(
      size, static_cast<uint32_t>(size + 0.5), step, importance_[row], lambda_, [&](uint32_t m) {
        return static_cast<double>(costs_[cls][rans_symbol(sign * static_cast<int32_t>(m))]);
      });
  return sign * static_cast<int32_t>(n);
}

std::vector<CodedComponent> LaneFieldEncoder::code_block(
    const std::vector<std::vector<float>>& targets) {
  const auto lanes = static_cast<uint32_t>(targets.size());
  const size_t first = items_.size();
  items_.resize(first + lanes);
  for (uint32_t l = 0; l < lanes; ++l) items_[first + l].reserve(field_.rows());
  std::vector<CodedComponent> out(lanes);
  field_.begin_block();
  for (uint32_t row = 0; row < field_.rows(); ++row) {
    const LaneGuess guess = field_.guess(row);
    int32_t n[kRansLanes] = {};
    for (uint32_t l = 0; l < lanes; ++l) {
      const double residual =
          static_cast<double>(targets[l][row]) - static_cast<double>(guess.prediction[l]);
      n[l] = decide(residual, guess.cls[l], row);
      items_[first + l].push_back({n[l], guess.cls[l]});
      out[l].bits += static_cast<double>(costs_[guess.cls[l]][rans_symbol(n[l])]);
    }
    field_.note(row, guess, n);
  }
  field_.end_block(lanes, planes_);
  for (uint32_t l = 0; l < lanes; ++l)
    out[l].error = squared_error(planes_[first + l], targets[l].data());
  return out;
}

RansEncoder LaneFieldEncoder::section(uint32_t components) const {
  RansEncoder out(std::min(kRansLanes, components));
  for (uint32_t k = 0, lanes = 0; k < components; k += lanes) {
    lanes = lanes_of_block(k, components);
    for (uint32_t row = 0; row < field_.rows(); ++row) {
      for (uint32_t l = 0; l < lanes; ++l) out.put(l, items_[k + l][row].cls, items_[k + l][row].n);
    }
  }
  return out;
}

}  // namespace reeb
