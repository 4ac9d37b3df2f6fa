#include "codec/common/fields/field.h"

#include <algorithm>

#include "codec/common/base/coding_tools.h"
#include "codec/common/base/integer_math.h"

namespace reeb {

namespace {

constexpr double kFading = 0.5;  ///< of what a group knows about weights, in the next one
constexpr uint32_t kMagnitudeCap = (1u << 24) - 1;  ///< keeps all sums within 32 bits

/// 2^16 / count, rounded down; 0 for nothing to take the mean of.
constexpr std::array<uint32_t, kMaxNeighbours + 1> kInverse = [] {
  std::array<uint32_t, kMaxNeighbours + 1> out{};
  for (uint32_t i = 1; i <= kMaxNeighbours; ++i) out[i] = 65536 / i;
  return out;
}();

/// 2^50 / step, rounded up, of every size of a step.
const std::array<uint64_t, kStepSizes> kInverseSteps = [] {
  std::array<uint64_t, kStepSizes> out{};
  for (uint32_t i = 0; i < kStepSizes; ++i)
    out[i] = ((uint64_t{1} << 50) + kStepTable[i] - 1) / kStepTable[i];
  return out;
}();

}  // namespace

FieldOptions surface_field_options(bool weak_prior) {
  return {.weights = weak_prior ? WeightOptions{.ring_deviation = 2.4, .extra_deviation = 1.5}
                                : WeightOptions{},
          .adaptive = uses(coding_tool::kReestimation),
          .noise_share = 2.2,
          .noise_floor = 0.2};
}

FieldOptions unpredicted_field_options() { return {.predict = false}; }

FieldOptions basis_field_options() {
  return {.weights = {.ring_deviation = 0.5, .extra_deviation = 0.25, .sum_to_one = false},
          .adaptive = uses(coding_tool::kBasisLearning),
          .noise_share = 0.5,
          .noise_floor = 0.05};
}

Field::Plan::Plan(const PredictionGraph& graph, bool predict) : uses(find_uses(graph)) {
  rows.reserve(graph.size());
  neighbours.reserve(graph.size());
  for (uint32_t r = 0; r < graph.size(); ++r) {
    const PredictionGraph::Row& row = graph.rows[r];
    const uint32_t step = predict ? graph.step_index[r] : 0;
    rows.push_back({kStepTable[step], kInverse[row.ring], kInverse[row.count - row.ring],
                    kInverseSteps[step]});
    neighbours.push_back(row.neighbour);
  }
}

Field::Field(const PredictionGraph& graph, const FieldOptions& options, unsigned threads)
    : options_(options),
      plan_(std::make_shared<const Plan>(graph, options.predict)),
      estimator_(graph, options.weights, threads),
      magnitude_(graph.size(), 0),
      last_(graph.size(), 0),
      history_(graph.size(), 0),
      near_(graph.size()),
      learned_components_(options.adaptive ? UINT32_MAX : 0) {}

void Field::learn_reference(const GridPoints& points, const std::vector<uint32_t>& order) {
  if (!options_.predict) return;
  if (learned_components_ > kObservations) {
    estimator_.observe_reference(points, order);
  } else {
    estimator_.borrow_reference(points, order);
  }
}

void Field::expect(uint32_t components) {
  if (options_.adaptive) learned_components_ = std::max(components, 1u) - 1;
}

std::vector<std::vector<float>> Field::next_group() {
  if (options_.adaptive) estimator_.fade(kFading, planes_);
  std::vector<std::vector<float>> planes = take_planes();
  planes_.clear();
  for (auto* magnitudes : {&last_, &history_}) std::fill(magnitudes->begin(), magnitudes->end(), 0);
  return planes;
}

void Field::note(uint32_t row, int64_t residual) {
  const uint64_t size = std::min<uint64_t>(
      static_cast<uint64_t>(residual < 0 ? -residual : residual), uint64_t{1} << 32);
  const auto magnitude =
      static_cast<uint32_t>(std::min<uint64_t>(size * plan_->rows[row].step >> 8, kMagnitudeCap));
  magnitude_[row] = magnitude;
  recent_ += magnitude;
  for (const uint32_t use : plan_->uses[row]) near_[use / 2][use % 2] += magnitude;
}

void Field::finish_component(double energy, bool learns) {
  const auto rows = static_cast<uint32_t>(magnitude_.size());
  for (uint32_t r = 0; r < rows; ++r) history_[r] = (history_[r] * 154 + magnitude_[r] * 102) >> 8;
  std::swap(last_, magnitude_);
  std::fill(magnitude_.begin(), magnitude_.end(), 0);
  std::fill(near_.begin(), near_.end(), std::array<uint32_t, 2>{});
  recent_ = 0;
  if (!learns) return;
  const uint32_t fine_rows = rows - rows / 4;
  estimator_.finish_component(options_.noise_share * (energy / fine_rows) + options_.noise_floor);
  estimator_.solve(misses_to_solve(component_count() - 1), planes_);
}

}  // namespace reeb
