// Coding of a field: component after component, row after row, each value predicted from earlier
// rows of the same component with weights learned from earlier components. Encoder and decoder run
// this same code.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "codec/common/fields/magnitude_model.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/prediction/weights.h"

namespace reeb {

struct FieldOptions {
  WeightOptions weights = {};
  bool predict = true;    ///< along the surface; false codes the values as they are
  bool adaptive = false;  ///< re-estimate weights; false keeps those of the reference
  // Of an adaptive field:
  double noise_share = 0;  ///< of a component's residual variance, as observation noise
  double noise_floor = 0;  ///< observation noise of a perfectly predicted component, in q^2
};

/// Options of the two fields of a group of the main profile; `weak_prior` as in its header.
FieldOptions surface_field_options(bool weak_prior = false);
FieldOptions basis_field_options();
/// Options of the one field of a group of the thesis profile.
FieldOptions unpredicted_field_options();

/// Values are in units of the group's quantization step q.
class Field {
 public:
  Field(const PredictionGraph& graph, const FieldOptions& options, unsigned threads);

  /// From now on, finding weights throws Stopped where it is requested.
  void set_stop(const StopToken& stop) { estimator_.set_stop(stop); }

  /// Whether a field that no more than so many components are expected of keeps what its rows have
  /// learned, which is most of what it takes; else that is found again when it is needed.
  static constexpr bool keeps_equations(uint32_t components) {
    return components > kObservations + 1;
  }

  /// Weights from the reference positions, which must outlive the field; call before the first
  /// component, surface graphs only.
  void learn_reference(const GridPoints& points, const std::vector<uint32_t>& order);

  /// Promises that there are no more than `components` before the field is used up: what would be
  /// learned for later ones is not. The values do not depend on it. To be called first, or for a
  /// group that continues another.
  void expect(uint32_t components);

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
  std::vector<std::vector<float>> take_planes() { return std::move(planes_); }

 private:
  /// What does not change while the field is coded.
  struct Plan {
    struct Row {
      uint32_t step;                  ///< in 1/65536 of q; all equal without prediction
      uint32_t ring_part, rest_part;  ///< 2^16 / neighbours in the ring and beyond, rounded down
      uint64_t inverse_step;          ///< 2^50 / step, rounded up
    };
    Plan(const PredictionGraph& graph, bool predict);
    std::vector<Row> rows;
    std::vector<std::array<uint32_t, kMaxNeighbours>> neighbours;  ///< the row itself for padding
    RowUses uses;
  };

  float predict(uint32_t row, const float* plane) const;
  Surroundings surroundings(uint32_t row) const;
  void note(uint32_t row, int64_t residual);
  void finish_component(double energy, bool learns);

  static constexpr uint32_t kRecent = 4;  ///< rows over which the recent mean fades

  FieldOptions options_;
  std::shared_ptr<const Plan> plan_;
  WeightEstimator estimator_;
  MagnitudeModel model_;
  std::vector<std::vector<float>> planes_;
  std::vector<uint32_t> magnitude_;  ///< |n| * step of the component being coded, in q / 256
  std::vector<uint32_t> last_;       ///< the magnitudes of the component before
  std::vector<uint32_t> history_;    ///< decaying mean of the magnitudes over components
  /// Sums of the magnitudes of each row's neighbours beyond the ring and in it.
  std::vector<std::array<uint32_t, 2>> near_;
  uint32_t learned_components_;  ///< the first ones
  uint32_t recent_ = 0;          ///< decaying mean along the rows, times 4
};

inline float Field::predict(uint32_t row, const float* plane) const {
  const float* w = estimator_.weights(row);
  const auto& neighbour = plan_->neighbours[row];
  float sum[4] = {0, 0, 0, 0};  // four running sums, so that vector units may take one each
  for (uint32_t i = 0; i < kMaxNeighbours; i += 4) {
    for (uint32_t j = 0; j < 4; ++j) sum[j] += w[i + j] * plane[neighbour[i + j]];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

inline Surroundings Field::surroundings(uint32_t row) const {
  const Plan::Row& r = plan_->rows[row];
  const auto [rest, ring] = near_[row];
  Surroundings s;
  s.ring_mean = static_cast<uint32_t>(uint64_t{ring} * r.ring_part >> 16);
  s.extra_mean =
      r.rest_part == 0 ? s.ring_mean : static_cast<uint32_t>(uint64_t{rest} * r.rest_part >> 16);
  s.recent = recent_ / kRecent;
  s.history = history_[row];
  s.last = last_[row];
  s.step = r.step;
  s.inverse_step = r.inverse_step;
  return s;
}

template <class Residual>
void Field::code_component(Residual&& residual) {
  if (planes_.empty() && options_.predict) estimator_.solve(1, planes_);
  const auto rows = static_cast<uint32_t>(magnitude_.size());
  const bool learns = component_count() < learned_components_;
  if (learns) estimator_.begin_component(planes_);
  std::vector<float>& plane = planes_.emplace_back(rows);
  double energy = 0;
  for (uint32_t row = 0; row < rows; ++row) {
    const float prediction = options_.predict ? predict(row, plane.data()) : 0;
    const Surroundings around = surroundings(row);
    MagnitudeModel::Bins bins(model_, around);
    const int64_t n = residual(row, prediction, around.step, bins);
    float value = prediction;
    if (n != 0) {
      const float correction = static_cast<float>(n) * (static_cast<float>(around.step) / 65536.0f);
      value += correction;
      // The coarse quarter does not count: its few large residuals say nothing of the rest.
      if (row >= rows / 4)
        energy += static_cast<double>(correction) * static_cast<double>(correction);
      note(row, n);
      if (learns) estimator_.miss(row);
    }
    recent_ -= recent_ / kRecent;
    plane[row] = value;
  }
  finish_component(energy, learns);
}

}  // namespace reeb
