#include "codec/common/field.h"

#include <algorithm>

#include "codec/common/coding_tools.h"
#include "codec/common/integer_math.h"

namespace reeb {

namespace {

constexpr uint32_t kRunning = 32;  ///< rows over which the running mean fades
constexpr uint32_t kRecent = 4;    ///< rows over which the recent mean fades
constexpr double kFading = 0.5;    ///< of what a group knows about weights, in the next one
constexpr uint32_t kMagnitudeCap = 1u << 24;  ///< keeps all context arithmetic within 32 bits

/// 2^50 / step, rounded up, of every level.
const std::array<uint64_t, kStepLevels> kInverseSteps = [] {
  std::array<uint64_t, kStepLevels> out{};
  for (uint32_t i = 0; i < kStepLevels; ++i)
    out[i] = ((uint64_t{1} << 50) + kStepTable[i] - 1) / kStepTable[i];
  return out;
}();

uint32_t level_of(uint32_t row, uint32_t rows) {
  return std::min(7u, log2_q5(std::max(1u, rows / (row + 1))) / 32);
}

}  // namespace

FieldOptions surface_field_options(Profile profile) {
  FieldOptions options;
  options.predict = profile != Profile::kThesis;
  options.adaptive = profile == Profile::kMain && uses(coding_tool::kReestimation);
  options.noise_share = 2.2;
  options.noise_floor = 0.2;
  options.weights.ring_deviation = 1.4;
  options.weights.extra_deviation = 0.9;
  return options;
}

FieldOptions basis_field_options() {
  FieldOptions options;
  options.weights = {.ring_deviation = 0.5, .extra_deviation = 0.25, .sum_to_one = false};
  options.adaptive = uses(coding_tool::kBasisLearning);
  options.noise_share = 0.5;
  options.noise_floor = 0.05;
  return options;
}

Field::Field(const PredictionGraph& graph, const FieldOptions& options, unsigned threads)
    : graph_(graph),
      options_(options),
      estimator_(graph, options.weights, threads),
      magnitude_(graph.size(), 0),
      last_(graph.size(), 0),
      history_(graph.size(), 0),
      ring_history_(graph.size(), 0),
      level_(graph.size()) {
  for (uint32_t r = 0; r < graph.size(); ++r)
    level_[r] = static_cast<uint8_t>(level_of(r, graph.size()));
  estimator_.solve();
}

void Field::learn_reference(const GridPoints& points, const std::vector<uint32_t>& order) {
  estimator_.observe_reference(points, order);
  estimator_.solve();
}

std::vector<std::vector<float>> Field::next_group() {
  if (options_.adaptive) estimator_.solve(kFading);
  std::vector<std::vector<float>> planes = take_planes();
  planes_.clear();
  for (auto* magnitudes : {&last_, &history_, &ring_history_}) {
    std::fill(magnitudes->begin(), magnitudes->end(), 0);
  }
  return planes;
}

float Field::predict(uint32_t row, const float* plane) const {
  if (!options_.predict) return 0;
  const float* w = estimator_.weights(row);
  const auto& neighbour = graph_.rows[row].neighbour;
  float sum[4] = {0, 0, 0, 0};  // four running sums, so that vector units may take one each
  for (uint32_t i = 0; i < kMaxNeighbours; i += 4) {
    for (uint32_t j = 0; j < 4; ++j) sum[j] += w[i + j] * plane[neighbour[i + j]];
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

Surroundings Field::surroundings(uint32_t row) const {
  const PredictionGraph::Row& r = graph_.rows[row];
  uint64_t ring = 0;
  uint64_t extra = 0;
  uint32_t largest = 0;
  for (uint32_t i = 0; i < r.ring; ++i) {
    ring += magnitude_[r.neighbour[i]];
    largest = std::max(largest, magnitude_[r.neighbour[i]]);
  }
  for (uint32_t i = r.ring; i < r.count; ++i) extra += magnitude_[r.neighbour[i]];
  const uint32_t step = step_of(row);
  // (x << 16) / step, by a product where that is exact: x * inverse errs by less than 2^34 / step.
  const uint64_t inverse = kInverseSteps[options_.predict ? graph_.step_level[row] : 0];
  const auto relative = [step, inverse](uint64_t x) {
    if (x < 1u << 18) return static_cast<uint32_t>(x * inverse >> 34);
    return static_cast<uint32_t>(std::min<uint64_t>((x << 16) / step, kMagnitudeCap));
  };
  Surroundings s;
  s.ring_mean = relative(r.ring > 0 ? ring / r.ring : 0);
  s.ring_max = relative(largest);
  s.history = relative(history_[row]);
  s.ring_history = relative(ring_history_[row]);
  s.running = relative(running_ / kRunning);
  s.recent = relative(recent_ / kRecent);
  s.last = relative(last_[row]);
  s.extra_mean = r.count > r.ring ? relative(extra / (r.count - r.ring)) : s.ring_mean;
  s.level = level_[row];
  s.component = static_cast<uint32_t>(planes_.size() - 1);
  return s;
}

void Field::note(uint32_t row, int64_t residual, uint32_t step) {
  const uint64_t size = std::min<uint64_t>(
      static_cast<uint64_t>(residual < 0 ? -residual : residual), uint64_t{kMagnitudeCap} << 8);
  const auto magnitude = static_cast<uint32_t>(std::min<uint64_t>(size * step >> 8, kMagnitudeCap));
  magnitude_[row] = magnitude;
  running_ += magnitude;
  running_ -= running_ / kRunning;
  recent_ += magnitude;
  recent_ -= recent_ / kRecent;
}

void Field::finish_component(double energy) {
  const auto k = static_cast<uint32_t>(planes_.size() - 1);
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    history_[r] =
        static_cast<uint32_t>((uint64_t{history_[r]} * 154 + uint64_t{magnitude_[r]} * 102) >> 8);
  }
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    uint64_t sum = 0;
    const uint32_t begin = graph_.link_begin[r];
    const uint32_t end = graph_.link_begin[r + 1];
    for (uint32_t i = begin; i < end; ++i) sum += history_[graph_.links[i]];
    ring_history_[r] = end > begin ? static_cast<uint32_t>(sum / (end - begin)) : 0;
  }
  last_ = magnitude_;
  std::fill(magnitude_.begin(), magnitude_.end(), 0);
  running_ = recent_ = 0;
  if (!options_.adaptive) return;
  const uint32_t fine_rows = graph_.size() - graph_.size() / 4;
  const double noise = options_.noise_share * (energy / fine_rows) + options_.noise_floor;
  estimator_.observe(planes_.back().data(), noise);
  if (resolve_after(k)) estimator_.solve();
}

}  // namespace reeb
