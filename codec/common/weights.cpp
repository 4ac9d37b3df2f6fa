#include "codec/common/weights.h"

#include <algorithm>
#include <new>

#include "codec/common/batches.h"
#include "codec/common/kernels.h"
#include "codec/common/parallel.h"

namespace reeb {

struct WeightEstimator::Batches {
  BatchVector<WeightBatch> items;
  Kernels kernels = fastest_kernels();
};

namespace {

void init_lane(WeightBatch& batch, uint32_t lane, uint32_t r, const PredictionGraph::Row& row,
               const WeightOptions& options) {
  batch.self[lane] = r;
  batch.count = std::max(batch.count, uint32_t{row.count});
  for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
    const double deviation = i < row.ring ? options.ring_deviation : options.extra_deviation;
    batch.neighbour[i][lane] = row.neighbour[i];
    batch.prior[i][lane] = static_cast<double>(row.prior[i]);
    batch.precision[i][lane] = static_cast<double>(row.precision[i]) / (deviation * deviation);
    batch.in_use[i][lane] = i < row.count ? 1.0 : 0.0;
  }
}

void fade(WeightBatch& batch, double factor) {
  for (Lanes& entry : batch.matrix) entry *= factor;
  for (Lanes& entry : batch.target) entry *= factor;
}

/// Rows batch * kLanes and on; lanes past the end repeat the last row, and their results are
/// dropped.
void init_batch(WeightBatch& batch, uint32_t index, const PredictionGraph& graph,
                const WeightOptions& options) {
  for (uint32_t lane = 0; lane < kLanes; ++lane) {
    const uint32_t row = std::min(index * kLanes + lane, graph.size() - 1);
    init_lane(batch, lane, row, graph.rows[row], options);
  }
}

/// The positions are exact to half a grid unit and to the surface's bending.
void observe_batch(const PredictionGraph& graph, const GridPoints& points,
                   const std::vector<uint32_t>& order, uint32_t index, const Kernels& kernels,
                   WeightBatch& batch) {
  constexpr double kGridVariance = 0.25;  // of half a grid unit
  constexpr double kBending = 2e-3;       // relative to the mean squared distance of the neighbours
  Lanes y[kMaxNeighbours][3] = {};
  Lanes inverse_noise{};
  for (uint32_t lane = 0; lane < kLanes; ++lane) {
    const uint32_t r = batch.self[lane];
    const PredictionGraph::Row& row = graph.rows[r];
    if (row.count == 0 || index * kLanes + lane > r) continue;
    int64_t spread = 0;
    for (uint32_t i = 0; i < row.count; ++i) {
      for (int a = 0; a < 3; ++a) {
        const int64_t d = points[order[row.neighbour[i]]][a] - points[order[r]][a];
        y[i][a][lane] = static_cast<double>(d);
        spread += d * d;
      }
    }
    inverse_noise[lane] =
        1.0 / (kGridVariance + kBending * (static_cast<double>(spread) / row.count));
  }
  kernels.observe_points(batch, y, inverse_noise);
}

}  // namespace

WeightEstimator::WeightEstimator(const PredictionGraph& graph, const WeightOptions& options,
                                 unsigned threads)
    : graph_(graph),
      options_(options),
      threads_(threads),
      batches_(std::make_unique<Batches>()),
      weights_(size_t{graph.size()} * kMaxNeighbours, 0.0f) {
  batches_->items.resize((graph.size() + kLanes - 1) / kLanes, WeightBatch{});
  for (uint32_t b = 0; b < batches_->items.size(); ++b)
    init_batch(batches_->items[b], b, graph, options);
}

WeightEstimator::~WeightEstimator() = default;

WeightEstimator::WeightEstimator(const WeightEstimator& other)
    : graph_(other.graph_),
      options_(other.options_),
      threads_(other.threads_),
      batches_(std::make_unique<Batches>(*other.batches_)),
      weights_(other.weights_) {}

void WeightEstimator::observe_reference(const GridPoints& points,
                                        const std::vector<uint32_t>& order) {
  for (uint32_t b = 0; b < batches_->items.size(); ++b)
    observe_batch(graph_, points, order, b, batches_->kernels, batches_->items[b]);
}

void WeightEstimator::observe(const float* values, double noise) {
  pending_.push_back({values, 1.0 / noise});
}

void WeightEstimator::solve(double fading) {
  float dropped[kMaxNeighbours];
  const auto count = static_cast<uint32_t>(batches_->items.size());
  parallel_ranges(count, threads_, [&](uint32_t begin, uint32_t end) {
    for (uint32_t b = begin; b < end; ++b) {
      WeightBatch& batch = batches_->items[b];
      for (const Observation& o : pending_) {
        batches_->kernels.accumulate(batch, o.values, o.inverse_noise, options_.sum_to_one);
      }
      if (fading != 1) fade(batch, fading);
      float* out[kLanes];
      for (uint32_t l = 0; l < kLanes; ++l) {
        const uint32_t row = b * kLanes + l;
        out[l] = row < graph_.size() ? &weights_[size_t{row} * kMaxNeighbours] : dropped;
      }
      batches_->kernels.solve(batch, options_.sum_to_one, out);
    }
  });
  pending_.clear();
}

std::vector<float> reference_weights(const PredictionGraph& graph, const WeightOptions& options,
                                     const GridPoints& points, const std::vector<uint32_t>& order) {
  const Kernels kernels = fastest_kernels();
  std::vector<float> weights(size_t{graph.size()} * kMaxNeighbours, 0.0f);
  float dropped[kMaxNeighbours];
  for (uint32_t b = 0; b * kLanes < graph.size(); ++b) {
    WeightBatch batch{};
    init_batch(batch, b, graph, options);
    observe_batch(graph, points, order, b, kernels, batch);
    float* out[kLanes];
    for (uint32_t l = 0; l < kLanes; ++l) {
      const uint32_t row = b * kLanes + l;
      out[l] = row < graph.size() ? &weights[size_t{row} * kMaxNeighbours] : dropped;
    }
    kernels.solve(batch, options.sum_to_one, out);
  }
  return weights;
}

}  // namespace reeb
