// Rate-distortion optimised quantization of a field.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/fields/field.h"
#include "codec/enc/fields/decision_recorder.h"

namespace reeb {

/// Quantizes and records one component after another. All values in units of the quantization step
/// q.
class FieldEncoder {
 public:
  /// A residual's decision minimises importance * error^2 + lambda * bits, the importance being the
  /// row's prediction mass to the power `mass_exponent`.
  FieldEncoder(Field& field, const PredictionGraph& graph, double lambda, double mass_exponent);

  /// Codes `target[row]`; returns the sum of squared errors.
  double code_component(const float* target);

  const DecisionRecorder& recorder() const { return recorder_; }

 private:
  int64_t decide(double residual, double step, double importance, MagnitudeModel::Bins& bins) const;

  Field& field_;
  double lambda_;
  std::vector<double> importance_;
  DecisionRecorder recorder_;
};

}  // namespace reeb
