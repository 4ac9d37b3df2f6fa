#include "codec/common/weights.h"

#include <algorithm>
#include <new>

#include "codec/common/kernels.h"
#include "codec/common/parallel.h"

namespace reeb {

struct WeightEstimator::Batches {
  std::vector<WeightBatch> items;
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

}  // namespace

WeightEstimator::WeightEstimator(const PredictionGraph& graph, const WeightOptions& options,
                                 unsigned threads)
    : graph_(graph),
      options_(options),
      threads_(threads),
      batches_(std::make_unique<Batches>()),
      weights_(size_t{graph.size()} * kMaxNeighbours, 0.0f) {
  batches_->items.resize((graph.size() + kLanes - 1) / kLanes, WeightBatch{});
  for (uint32_t r = 0; r < batches_->items.size() * kLanes; ++r) {
    // Lanes past the end repeat the last row; their results are dropped.
    const uint32_t row = std::min(r, graph.size() - 1);
    init_lane(batches_->items[r / kLanes], r % kLanes, row, graph.rows[row], options);
  }
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
  constexpr double kGridVariance = 0.25;  // of half a grid unit
  constexpr double kBending = 2e-3;       // relative to the mean squared distance of the neighbours
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    const PredictionGraph::Row& row = graph_.rows[r];
    double y[kMaxNeighbours][3];
    double spread = 0;
    for (uint32_t i = 0; i < row.count; ++i) {
      for (int a = 0; a < 3; ++a) {
        y[i][a] = points[order[row.neighbour[i]]][a] - points[order[r]][a];
        spread += y[i][a] * y[i][a];
      }
    }
    if (row.count == 0) continue;
    const double inverse_noise = 1.0 / (kGridVariance + kBending * (spread / row.count));
    WeightBatch& batch = batches_->items[r / kLanes];
    for (uint32_t i = 0; i < row.count; ++i) {
      for (uint32_t j = 0; j <= i; ++j) {
        const double dot = y[i][0] * y[j][0] + y[i][1] * y[j][1] + y[i][2] * y[j][2];
        batch.matrix[packed(i, j)][r % kLanes] += dot * inverse_noise;
      }
    }
  }
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

}  // namespace reeb
