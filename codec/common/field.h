// Coding of a field: component after component, row after row, each value predicted from earlier
// rows of the same component with weights learned from earlier components. Encoder and decoder run
// this same code.
#pragma once

#include <cstdint>
#include <deque>
#include <iterator>
#include <vector>

#include "bitstream/headers.h"
#include "codec/common/magnitude_model.h"
#include "codec/common/prediction_graph.h"
#include "codec/common/weights.h"

namespace reeb {

struct FieldOptions {
  WeightOptions weights;
  double noise_share = 0.8;   ///< of a component's residual variance, as observation noise
  double noise_floor = 0.02;  ///< observation noise of a perfectly predicted component, in q^2
  bool predict = true;        ///< along the surface; false codes the values as they are
  bool adaptive = true;  ///< re-estimate weights; false keeps those of the reference (fast profile)
};

/// Options of the two fields of a group.
FieldOptions surface_field_options(Profile profile);
FieldOptions basis_field_options();

/// Values are in units of the group's quantization step q.
class Field {
 public:
  Field(const PredictionGraph& graph, const FieldOptions& options, unsigned threads);

  /// Weights from the reference positions; call before the first component, surface graphs only.
  void learn_reference(const GridPoints& points, const std::vector<uint32_t>& order);

  /// Codes the next component. `residual(row, prediction, step, bins)` gives the quantized residual
  /// n; the value becomes prediction + n * step / 65536.
  template <class Residual>
  void code_component(Residual&& residual);

  /// Ends a group and starts the next one: weights and contexts stay as learned, planes and
  /// magnitudes go. Returns the planes.
  std::vector<std::vector<float>> next_group();

  uint32_t component_count() const { return static_cast<uint32_t>(planes_.size()); }
  /// Decoded values of component k, one per row.
  const std::vector<float>& plane(uint32_t k) const { return planes_[k]; }
  MagnitudeModel& model() { return model_; }
  /// All decoded planes; the field is used up.
  std::vector<std::vector<float>> take_planes() {
    return {std::make_move_iterator(planes_.begin()), std::make_move_iterator(planes_.end())};
  }

 private:
  /// In 1/65536 of q; without prediction no row matters to others, and all steps are equal.
  uint32_t step_of(uint32_t row) const {
    return options_.predict ? kStepTable[graph_.step_level[row]] : 65536;
  }
  float predict(uint32_t row, const float* plane) const;
  Surroundings surroundings(uint32_t row) const;
  void note(uint32_t row, int64_t residual, uint32_t step);
  void finish_component(double energy);
  void learn(double energy);

  const PredictionGraph& graph_;
  FieldOptions options_;
  WeightEstimator estimator_;
  MagnitudeModel model_;
  std::deque<std::vector<float>>
      planes_;                       ///< a deque: the estimator keeps pointers to its elements
  std::vector<uint32_t> magnitude_;  ///< |n| * step of the component being coded, in q / 256
  std::vector<uint32_t> last_;       ///< the magnitudes of the component before
  std::vector<uint32_t> history_;    ///< decaying mean of the magnitudes over components
  uint32_t recent_ = 0;              ///< decaying mean along the rows, times 4
};

template <class Residual>
void Field::code_component(Residual&& residual) {
  if (planes_.empty() && options_.predict) estimator_.solve();
  std::vector<float>& plane = planes_.emplace_back(graph_.size());
  double energy = 0;
  for (uint32_t row = 0; row < graph_.size(); ++row) {
    const float prediction = predict(row, plane.data());
    const uint32_t step = step_of(row);
    const Surroundings around = surroundings(row);
    MagnitudeModel::Bins bins(model_, around);
    const int64_t n = residual(row, prediction, step, bins);
    const float correction = static_cast<float>(n) * (static_cast<float>(step) / 65536.0f);
    plane[row] = prediction + correction;
    // The coarse quarter does not count: its few large residuals say nothing of the rest.
    if (row >= graph_.size() / 4)
      energy += static_cast<double>(correction) * static_cast<double>(correction);
    note(row, n, step);
  }
  finish_component(energy);
}

}  // namespace reeb
