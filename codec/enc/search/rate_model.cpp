#include "codec/enc/search/rate_model.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "codec/common/fields/field.h"
#include "codec/enc/fields/stop_rule.h"

namespace reeb {

namespace {

constexpr uint32_t kMaxSamples = 4096;
constexpr uint32_t kActivities = 5;  ///< classes of a row's energy, a factor of 16 apart
constexpr double kNoiseGain = 0.9;   ///< of a prediction: what it takes over of the errors of rows
                                     ///< that are an octave coarser

uint32_t octave_of(uint32_t row) { return static_cast<uint32_t>(std::bit_width(row)); }

/// Class of a row by its energy relative to the mean.
uint32_t activity_of(double energy, double mean) {
  if (!(energy > 0)) return 0;
  const double activity = std::floor(std::log2(energy / mean) / 4) + (kActivities - 2);
  return static_cast<uint32_t>(std::clamp(activity, 0.0, double{kActivities} - 1));
}

/// Where an optimising quantizer gives up on 1, in steps, if a bit costs `price` squared steps.
double dead_zone(double scale, double step, double price) {
  const double ratio = std::exp(-0.6 * step / std::max(scale, 1e-30));
  const double zero = 1 - ratio;
  const double one = 0.5 * ratio * (1 - std::exp(-step / std::max(scale, 1e-30)));
  const double bits = std::clamp(std::log2(zero / std::max(one, 1e-30)), 0.0, 12.0);
  return std::min(1.2, 0.5 + 0.5 * price * bits);
}

}  // namespace

RateModel::RateModel(const SurfaceContext& surface, KarhunenLoeve& transform, uint32_t frames,
                     const RateModelOptions& options)
    : transform_(transform), vertices_(surface.rows()), frames_(frames), options_(options) {
  sort_samples(surface);
}

void RateModel::sort_samples(const SurfaceContext& surface) {
  const PredictionGraph& graph = surface.surface.graph;
  const std::vector<float>& weights = surface.surface.lanes().weights;
  const Eigen::VectorXd energy = transform_.row_energies();
  const double mean = energy.mean();
  const uint32_t octaves = octave_of(graph.size()) + 1;
  bands_.resize(size_t{octaves} * kActivities);
  const uint32_t stride = (graph.size() + kMaxSamples - 1) / kMaxSamples;
  for (uint32_t row = 0; row < graph.size(); ++row) {
    const double e = energy[surface.input[row]];
    Band& band = bands_[octave_of(row) * kActivities + activity_of(e, mean)];
    band.activity = activity_of(e, mean);
    band.rows += 1;
    band.step += static_cast<double>(kStepTable[graph.step_index[row]]) / 65536;
    band.importance += std::exp2(options_.mass_exponent * graph.step_index[row] / 8.0);
    if ((static_cast<uint32_t>(band.rows) - 1) % stride != 0) continue;
    Sample& sample = band.samples.emplace_back();
    sample.vertex = surface.input[row];
    for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
      sample.neighbours[i] = surface.input[graph.rows[row].neighbour[i]];
      sample.weights[i] = weights[size_t{row} * kMaxNeighbours + i];
    }
  }
  std::erase_if(bands_, [](const Band& b) { return b.samples.empty(); });
  for (Band& band : bands_) {
    band.step /= band.rows;
    band.importance /= band.rows;
  }
}

const std::vector<double>& RateModel::scales(uint32_t k) {
  while (scales_.size() <= k) {
    const float* x = transform_.coefficients(static_cast<uint32_t>(scales_.size()));
    std::vector<double>& out = scales_.emplace_back();
    for (const Band& band : bands_) {
      double sum = 0;
      for (const Sample& s : band.samples) {
        float residual = x[s.vertex];
        for (uint32_t i = 0; i < kMaxNeighbours; ++i) residual -= s.weights[i] * x[s.neighbours[i]];
        sum += static_cast<double>(std::abs(residual));
      }
      out.push_back(sum / static_cast<double>(band.samples.size()));
    }
  }
  return scales_[k];
}

RatePoint RateModel::component(uint32_t k, double q) {
  RatePoint out;
  const std::vector<double>& scale = scales(k);
  std::array<double, kActivities> coarser{};  // error of a row one octave up
  for (size_t i = 0; i < bands_.size(); ++i) {
    const Band& band = bands_[i];
    const double step = band.step * q;
    const double noise = kNoiseGain * coarser[band.activity];
    const double own = options_.residual_share * scale[i];
    const double b = std::sqrt(own * own + noise / 2);
    const double price = options_.lambda / (band.step * band.step * band.importance);
    const RatePoint point = quantized_laplace_source(b, step, dead_zone(b, step, price));
    coarser[band.activity] = point.distortion;
    out.bits += options_.rate_share * band.rows * point.bits;
    out.distortion += band.rows * point.distortion;
  }
  return out;
}

RatePoint RateModel::at(double q, std::optional<uint32_t> held) {
  const uint32_t most = std::min(held.value_or(transform_.size()), transform_.size());
  StopRule stop(vertices_, frames_, options_.lambda);
  std::vector<RatePoint> sums{{0, 0}};
  double unsent = transform_.energies().sum();
  double distortion = 0;
  bool more = true;
  for (uint32_t k = 0; k < most && more; ++k) {
    const double energy = transform_.energies()[k];
    const RatePoint point = component(k, q);
    distortion += point.distortion;
    unsent -= energy;
    more = stop.add(energy / (q * q), point.distortion / (q * q), point.bits) || held;
    sums.push_back({stop.bits(), distortion + std::max(0.0, unsent)});
  }
  sums[0].distortion = transform_.energies().sum();
  return sums[held ? most : stop.best()];
}

}  // namespace reeb
