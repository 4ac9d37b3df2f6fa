#include "codec/common/fast/lane_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "codec/common/base/largest_magnitude.h"

namespace reeb {

namespace {

constexpr uint32_t kLearnedBlocks = 2;  ///< more gain little

/// Four lanes of four rows, from `values` on, to four planes.
void turn_four(const float* values, size_t row, float* const* planes) {
  using Four = float __attribute__((vector_size(16)));
  Four in[4];
  for (uint32_t i = 0; i < 4; ++i)
    std::memcpy(&in[i], values + size_t{i} * kRansLanes, sizeof in[i]);
  const Four low01 = __builtin_shufflevector(in[0], in[1], 0, 4, 1, 5);
  const Four low23 = __builtin_shufflevector(in[2], in[3], 0, 4, 1, 5);
  const Four high01 = __builtin_shufflevector(in[0], in[1], 2, 6, 3, 7);
  const Four high23 = __builtin_shufflevector(in[2], in[3], 2, 6, 3, 7);
  const Four out[4] = {__builtin_shufflevector(low01, low23, 0, 1, 4, 5),
                       __builtin_shufflevector(low01, low23, 2, 3, 6, 7),
                       __builtin_shufflevector(high01, high23, 0, 1, 4, 5),
                       __builtin_shufflevector(high01, high23, 2, 3, 6, 7)};
  for (uint32_t l = 0; l < 4; ++l) std::memcpy(planes[l] + row, &out[l], sizeof out[l]);
}

}  // namespace

LaneField::LaneField(const PredictionGraph& graph, std::span<const float> weights)
    : graph_(graph),
      steps_(graph.size()),
      values_(size_t{graph.size()} * kRansLanes),
      magnitudes_(values_.size()),
      history_(graph.size(), 0) {
  for (uint32_t r = 0; r < graph.size(); ++r)
    steps_[r] = static_cast<float>(kStepTable[graph.step_index[r]]) / 65536.0f;
  block_.rows = graph.rows.data();
  block_.row_count = graph.size();
  block_.weights = weights.data();
  block_.steps = steps_.data();
  block_.values = values_.data();
  block_.magnitudes = magnitudes_.data();
}

LaneField::LaneField(const PredictionGraph& graph, const LaneStart& start, bool wary)
    : LaneField(graph, start.weights) {
  start_ = &start;
  wary_ = wary;
}

// Values and magnitudes stay: a row sees but those of rows before it, which are new.
void LaneField::begin_block(const StopToken& stop) {
  if (start_ != nullptr && blocks_ > 0 && blocks_ <= kLearnedBlocks) learn(stop);
  std::fill(std::begin(block_.running), std::end(block_.running), 0u);
  std::fill(std::begin(block_.before), std::end(block_.before), 0u);
}

void LaneField::end_block(uint32_t lanes, Planes& planes) {
  for (uint32_t r = 0; r < rows(); ++r) {
    uint32_t sum = 0;
    for (uint32_t l = 0; l < kRansLanes; ++l) sum += magnitudes_[r * kRansLanes + l];
    // The mean in 1/16, of half as many lanes in the first block.
    history_[r] = block_.history == nullptr ? 2 * sum : (history_[r] + 3 * sum) / 4;
  }
  block_.history = history_.data();
  ++blocks_;
  std::array<float*, kRansLanes> plane;
  std::vector<float> spare(lanes % 4 == 0 ? 0 : rows());  // for lanes that are not used
  plane.fill(spare.data());
  for (uint32_t l = 0; l < lanes; ++l) plane[l] = planes.emplace_back(rows()).data();
  uint32_t row = 0;
  for (; row + 4 <= rows(); row += 4) {
    for (uint32_t l = 0; l < lanes; l += 4)
      turn_four(&values_[size_t{row} * kRansLanes + l], row, &plane[l]);
  }
  for (; row < rows(); ++row) {
    for (uint32_t l = 0; l < lanes; ++l) plane[l][row] = values_[size_t{row} * kRansLanes + l];
  }
}

// The more is known, the worse a row must have been predicted to be worth the time.
void LaneField::learn(const StopToken& stop) {
  constexpr uint32_t kMinHistory = 4;
  std::vector<uint32_t> badly;
  for (uint32_t r = 0; r < rows(); ++r) {
    if (history_[r] >= kMinHistory * blocks_) badly.push_back(r);
  }
  LaneWeightTask task = {graph_.rows.data(), start_->points.data(), values_.data()};
  if (wary_) task.history = history_.data();
  if (blocks_ == 1) {
    weights_ = start_->weights;
    block_.weights = weights_.data();
  } else {
    task.first_values = first_values_.data();
  }
  learn_weights(task, badly, weights_, stop);
  if (blocks_ == 1) keep_first_values();
}

void LaneField::keep_first_values() {
  first_values_.reserve(size_t{rows()} * kFirstLanes);
  for (size_t r = 0; r < rows(); ++r) {
    const auto from = values_.begin() + static_cast<std::ptrdiff_t>(r * kRansLanes);
    first_values_.insert(first_values_.end(), from, from + kFirstLanes);
  }
}

bool decode_lane_field(std::span<const uint8_t> section, uint32_t components, LaneField& field,
                       LaneField::Planes& planes, const StopToken& stop) {
  RansDecoder decoder;
  if (!decoder.open(section, std::min(kRansLanes, components))) return false;
  for (uint32_t k = 0, lanes = 0; k < components; k += lanes) {
    lanes = lanes_of_block(k, components);
    field.begin_block(stop);
    field.decode_rows(decoder, lanes);
    field.end_block(lanes, planes);
    if (decoder.overrun() || stop.requested()) return false;
    for (uint32_t l = 0; l < lanes; ++l) {
      if (!std::isfinite(largest_magnitude(planes[k + l]))) return false;
    }
  }
  return true;
}

std::vector<float> prior_weights(const PredictionGraph& graph) {
  std::vector<float> out(size_t{graph.size()} * kMaxNeighbours);
  for (uint32_t r = 0; r < graph.size(); ++r)
    std::copy(graph.rows[r].prior.begin(), graph.rows[r].prior.end(),
              &out[size_t{r} * kMaxNeighbours]);
  return out;
}

}  // namespace reeb
