#include "codec/common/field.h"

#include <algorithm>

#include "codec/common/coding_tools.h"
#include "codec/common/integer_math.h"

namespace reeb {

namespace {

constexpr uint32_t kRecent = 4;  ///< rows over which the recent mean fades
constexpr float kFading = 0.5f;  ///< of what a group knows about weights, in the next one
constexpr uint32_t kMagnitudeCap = 1u << 24;  ///< keeps all context arithmetic within 32 bits

/// 2^16 / count, rounded down; 0 for nothing to take the mean of.
constexpr std::array<uint32_t, kMaxNeighbours + 1> kInverse = [] {
  std::array<uint32_t, kMaxNeighbours + 1> out{};
  for (uint32_t i = 1; i <= kMaxNeighbours; ++i) out[i] = 65536 / i;
  return out;
}();

/// 2^50 / step, rounded up, of every level.
const std::array<uint64_t, kStepLevels> kInverseSteps = [] {
  std::array<uint64_t, kStepLevels> out{};
  for (uint32_t i = 0; i < kStepLevels; ++i)
    out[i] = ((uint64_t{1} << 50) + kStepTable[i] - 1) / kStepTable[i];
  return out;
}();

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
      history_(graph.size(), 0) {}

void Field::learn_reference(const GridPoints& points, const std::vector<uint32_t>& order) {
  estimator_.observe_reference(points, order);
}

std::vector<std::vector<float>> Field::next_group() {
  if (options_.adaptive) estimator_.fade(kFading);
  std::vector<std::vector<float>> planes = take_planes();
  planes_.clear();
  for (auto* magnitudes : {&last_, &history_}) std::fill(magnitudes->begin(), magnitudes->end(), 0);
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
  uint32_t ring = 0;
  uint32_t extra = 0;
  for (uint32_t i = 0; i < r.ring; ++i) ring += magnitude_[r.neighbour[i]];
  for (uint32_t i = r.ring; i < r.count; ++i) extra += magnitude_[r.neighbour[i]];
  const auto mean = [](uint32_t sum, uint32_t count) {
    return static_cast<uint32_t>(uint64_t{sum} * kInverse[count] >> 16);
  };
  Surroundings s;
  s.ring_mean = mean(ring, r.ring);
  s.extra_mean = r.count > r.ring ? mean(extra, r.count - r.ring) : s.ring_mean;
  s.recent = recent_ / kRecent;
  s.history = history_[row];
  s.last = last_[row];
  if (options_.predict) {
    s.step = kStepTable[graph_.step_level[row]];
    s.inverse_step = kInverseSteps[graph_.step_level[row]];
  }
  return s;
}

void Field::note(uint32_t row, int64_t residual, uint32_t step) {
  const uint64_t size = std::min<uint64_t>(
      static_cast<uint64_t>(residual < 0 ? -residual : residual), uint64_t{kMagnitudeCap} << 8);
  const auto magnitude = static_cast<uint32_t>(std::min<uint64_t>(size * step >> 8, kMagnitudeCap));
  magnitude_[row] = magnitude;
  recent_ += magnitude;
  recent_ -= recent_ / kRecent;
}

void Field::finish_component(double energy) {
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    history_[r] =
        static_cast<uint32_t>((uint64_t{history_[r]} * 154 + uint64_t{magnitude_[r]} * 102) >> 8);
  }
  recent_ = 0;
  if (options_.adaptive) learn(energy);
  std::swap(last_, magnitude_);
  std::fill(magnitude_.begin(), magnitude_.end(), 0);
}

void Field::learn(double energy) {
  const uint32_t fine_rows = graph_.size() - graph_.size() / 4;
  const double noise = options_.noise_share * (energy / fine_rows) + options_.noise_floor;
  estimator_.observe(planes_.back(), magnitude_, noise);
  if (resolve_after(component_count() - 1)) estimator_.solve();
}

}  // namespace reeb
