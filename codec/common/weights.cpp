#include "codec/common/weights.h"

#include <algorithm>
#include <cmath>

#include "codec/common/parallel.h"

namespace reeb {

namespace {

void init_lane(WeightBatch& batch, uint32_t lane, const PredictionGraph::Row& row,
               const WeightOptions& options) {
  batch.count = std::max(batch.count, uint32_t{row.count});
  for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
    const double deviation = i < row.ring ? options.ring_deviation : options.extra_deviation;
    batch.prior[i][lane] = static_cast<double>(row.prior[i]);
    batch.precision[i][lane] = static_cast<double>(row.precision[i]) / (deviation * deviation);
    batch.in_use[i][lane] = i < row.count ? 1.0 : 0.0;
  }
}

void init_batch(WeightBatch& batch, const uint32_t rows[kLanes], const PredictionGraph& graph,
                const WeightOptions& options) {
  batch.count = 0;
  for (uint32_t lane = 0; lane < kLanes; ++lane)
    init_lane(batch, lane, graph.rows[rows[lane]], options);
}

/// The positions are exact to half a grid unit and to the surface's bending.
void observe_batch(const PredictionGraph& graph, const GridPoints& points,
                   const std::vector<uint32_t>& order, const uint32_t rows[kLanes],
                   const Kernels& kernels, WeightBatch& batch) {
  constexpr double kGridVariance = 0.25;  // of half a grid unit
  constexpr double kBending = 2e-3;       // relative to the mean squared distance of the neighbours
  Lanes y[kMaxNeighbours][3] = {};
  Lanes inverse_noise{};
  for (uint32_t lane = 0; lane < kLanes; ++lane) {
    const uint32_t r = rows[lane];
    const PredictionGraph::Row& row = graph.rows[r];
    if (row.count == 0) continue;
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

/// All rows together are far larger than what the processor keeps at hand.
void prefetch(const RowEquations& row) {
  constexpr size_t kCacheLine = 64;
  const auto* bytes = reinterpret_cast<const char*>(&row);
  for (size_t at = 0; at < sizeof row; at += kCacheLine) __builtin_prefetch(bytes + at, 1);
}

}  // namespace

WeightEstimator::WeightEstimator(const PredictionGraph& graph, const WeightOptions& options,
                                 unsigned threads)
    : graph_(graph),
      options_(options),
      threads_(threads),
      targets_(options.sum_to_one ? 0 : graph.size()),
      values_(size_t{graph.size()} * kObservations),
      folded_(graph.size(), 0),
      misses_(graph.size(), kNeverSolved),
      weights_(size_t{graph.size()} * kMaxNeighbours, 0.0f) {}

void WeightEstimator::observe_reference(const GridPoints& points,
                                        const std::vector<uint32_t>& order) {
  equations_.resize(graph_.size());
  float dropped[kMaxNeighbours];
  for (uint32_t first = 0; first < graph_.size(); first += kLanes) {
    WeightBatch batch{};
    uint32_t rows[kLanes];
    float* out[kLanes];
    RowEquations* equations[kLanes];
    for (uint32_t l = 0; l < kLanes; ++l) {
      // Lanes past the end repeat the last row.
      rows[l] = std::min(first + l, graph_.size() - 1);
      out[l] = first + l == rows[l] ? &weights_[size_t{rows[l]} * kMaxNeighbours] : dropped;
      equations[l] = &equations_[rows[l]];
      *equations[l] = {};
    }
    init_batch(batch, rows, graph_, options_);
    observe_batch(graph_, points, order, rows, kernels_, batch);
    kernels_.solve(batch, options_.sum_to_one, out);
    kernels_.store_equations(batch, equations);
  }
  std::fill(misses_.begin(), misses_.end(), uint8_t{0});
}

// Not before: a field that learns nothing needs none, and what the reference gives is written once.
void WeightEstimator::make_equations() {
  if (equations_.empty()) equations_.resize(graph_.size(), RowEquations{});
}

// As late as can be: after the last component that anything is solved for, rows need not learn.
void WeightEstimator::begin_component() {
  make_equations();
  if (observations_ < kObservations) return;
  parallel_ranges(graph_.size(), threads_, [&](uint32_t begin, uint32_t end) {
    for (uint32_t r = begin; r < end; ++r) {
      if (r + 1 < end) prefetch(equations_[r + 1]);
      fold(r);
    }
  });
  std::fill(folded_.begin(), folded_.end(), uint8_t{0});
  observations_ = 0;
}

void WeightEstimator::finish_component(double noise) {
  scale_[observations_++] = 1.0 / std::sqrt(noise);
}

void WeightEstimator::fold(uint32_t r) {
  const PredictionGraph::Row& row = graph_.rows[r];
  if (folded_[r] == observations_) return;
  kernels_.fold(
      equations_[r], options_.sum_to_one ? nullptr : targets_[r].data(),
      {values_.data(), scale_, row.neighbour.data(), row.count, r, folded_[r], observations_});
  folded_[r] = static_cast<uint8_t>(observations_);
}

void WeightEstimator::fade(double factor) {
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    fold(r);
    for (Lanes& entries : equations_[r].strip) entries *= factor;
    if (options_.sum_to_one) continue;
    for (double& entry : targets_[r]) entry *= factor;
  }
  std::fill(misses_.begin(), misses_.end(), kNeverSolved);
}

void WeightEstimator::solve(uint32_t misses) {
  make_equations();
  std::vector<uint32_t> rows;
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    if (misses_[r] < misses) continue;
    rows.push_back(r);
    misses_[r] = 0;
  }
  const auto eights = static_cast<uint32_t>((rows.size() + kLanes - 1) / kLanes);
  parallel_ranges(eights, threads_, [&](uint32_t begin, uint32_t end) {
    for (uint32_t first = begin * kLanes; first < end * kLanes; first += kLanes)
      solve_eight(rows, first);
  });
}

void WeightEstimator::solve_eight(const std::vector<uint32_t>& rows, uint32_t first) {
  const uint32_t count = std::min(kLanes, static_cast<uint32_t>(rows.size()) - first);
  float dropped[kMaxNeighbours];
  const RowEquations* equations[kLanes];
  uint32_t row[kLanes];
  float* out[kLanes];
  for (uint32_t l = 0; l < kLanes; ++l) {
    // Lanes past the end repeat the last row; their results are dropped.
    row[l] = rows[first + std::min(l, count - 1)];
    if (first + l + 1 < rows.size()) prefetch(equations_[rows[first + l + 1]]);
    if (l < count) fold(row[l]);
    equations[l] = &equations_[row[l]];
    out[l] = l < count ? &weights_[size_t{row[l]} * kMaxNeighbours] : dropped;
  }
  WeightBatch batch;
  init_batch(batch, row, graph_, options_);
  kernels_.load_equations(batch, equations);
  for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
    for (uint32_t l = 0; l < kLanes; ++l)
      batch.target[i][l] = options_.sum_to_one ? 0 : targets_[row[l]][i];
  }
  kernels_.solve(batch, options_.sum_to_one, out);
}

}  // namespace reeb
