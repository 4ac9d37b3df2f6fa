// Rate-distortion optimised quantization of a field of the fast profile.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/common/fast/lane_field.h"

namespace reeb {

/// Bits of every symbol by class.
using SymbolCosts = std::array<std::array<float, kRansSymbols>, kRansClasses>;

/// Costs before anything is known: magnitudes fall geometrically around what the class expects.
SymbolCosts expected_costs();
/// Costs of what was coded.
SymbolCosts costs_of(const RansTables& tables);

/// What came of one component.
struct CodedComponent {
  double error = 0;  ///< sum of squares, in units of the quantization step
  double bits = 0;   ///< estimated
};

/// Codes planes in blocks. All values are in units of the quantization step.
class LaneFieldEncoder {
 public:
  /// A residual's decision minimises importance * error^2 + lambda * bits, the importance being the
  /// row's prediction mass to the power `mass_exponent`.
  LaneFieldEncoder(LaneField& field, const PredictionGraph& graph, double lambda,
                   double mass_exponent, const SymbolCosts& costs);

  /// Codes the next lanes_of_block planes; `targets[lane][row]`.
  std::vector<CodedComponent> code_block(const std::vector<std::vector<float>>& targets);

  const LaneField::Planes& planes() const { return planes_; }
  /// The first `components` of them as a section.
  RansEncoder section(uint32_t components) const;

 private:
  int32_t decide(double residual, uint32_t cls, uint32_t row) const;

  struct Item {
    int32_t n;
    uint32_t cls;
  };
  LaneField& field_;
  double lambda_;
  std::vector<double> importance_;
  const SymbolCosts& costs_;
  LaneField::Planes planes_;
  std::vector<std::vector<Item>> items_;  ///< [component][row]
};

}  // namespace reeb
