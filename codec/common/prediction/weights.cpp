#include "codec/common/prediction/weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "codec/common/base/item_lists.h"
#include "codec/common/base/parallel.h"
#include "codec/common/prediction/point_noise_impl.h"

namespace reeb {

namespace {

/// The positions are exact to their noise.
void observe_rows(const PredictionGraph& graph, const GridPoints& points,
                  const std::vector<uint32_t>& order, const uint32_t rows[kRowsAtOnce],
                  const WeightKernels& kernels, RowEquations* const out[kRowsAtOnce]) {
  constexpr double kBending = 2e-3;
  PointDifferences y{};
  uint32_t most = 0;
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
    const uint32_t r = rows[l];
    const PredictionGraph::Row& row = graph.rows[r];
    most = std::max(most, uint32_t{row.count});
    if (row.count == 0) continue;
    int64_t spread = 0;
    for (uint32_t i = 0; i < row.count; ++i) {
      for (int a = 0; a < 3; ++a) {
        const int64_t d = points[order[row.neighbour[i]]][a] - points[order[r]][a];
        y.neighbour[i][a][l] = static_cast<double>(d);
        spread += d * d;
      }
    }
    y.inverse_noise[l] = 1.0 / point_noise(static_cast<double>(spread) / row.count, kBending);
  }
  kernels.observe_points(y, most, out);
}

/// All rows together are far larger than what the processor keeps at hand.
template <class Row>
void prefetch(const Row& row) {
  constexpr size_t kCacheLine = 64;
  const auto* bytes = reinterpret_cast<const char*>(&row);
  for (size_t at = 0; at < sizeof row; at += kCacheLine) __builtin_prefetch(bytes + at, 1);
}

std::vector<uint32_t> rows_by_count(const PredictionGraph& graph) {
  const ItemLists<uint32_t> by_count(kMaxNeighbours + 1, [&](auto put) {
    for (uint32_t r = 0; r < graph.size(); ++r) put(graph.rows[r].count, r);
  });
  return {by_count.items().begin(), by_count.items().end()};
}

}  // namespace

WeightEstimator::WeightEstimator(const PredictionGraph& graph, const WeightOptions& options,
                                 unsigned threads)
    : graph_(graph),
      options_(options),
      threads_(threads),
      targets_(options.sum_to_one ? 0 : graph.size()),
      folded_(graph.size(), 0),
      misses_(graph.size(), kNeverSolved),
      by_count_(rows_by_count(graph)),
      weights_(size_t{graph.size()} * kMaxNeighbours, 0.0f) {}

void WeightEstimator::observe_reference(const GridPoints& points,
                                        const std::vector<uint32_t>& order) {
  equations_.resize(graph_.size());
  solve_reference([&](uint32_t first) {
    uint32_t eight[kRowsAtOnce];
    RowEquations* out[kRowsAtOnce];
    for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
      eight[l] = std::min(first + l, graph_.size() - 1);
      out[l] = &equations_[eight[l]];
    }
    observe_rows(graph_, points, order, eight, kernels_, out);
  });
}

void WeightEstimator::borrow_reference(const GridPoints& points,
                                       const std::vector<uint32_t>& order) {
  borrowed_ = {points, &order};
  solve_reference([](uint32_t) {});
}

template <class Prepare>
void WeightEstimator::solve_reference(Prepare prepare) {
  std::vector<uint32_t> rows(graph_.size());
  std::iota(rows.begin(), rows.end(), 0u);
  for (uint32_t first = 0; first < graph_.size(); first += kRowsAtOnce) {
    stop_.check();
    prepare(first);
    solve_eight(rows, first, {});  // while they are at hand
  }
  std::fill(misses_.begin(), misses_.end(), uint8_t{0});
}

// Not before: a field that learns nothing needs none, and what the reference gives is written once.
void WeightEstimator::make_equations() {
  if (equations_.empty() && !borrowed_) make_batches(graph_.size(), stop_, equations_);
}

WeightEstimator::List WeightEstimator::list(const Planes& planes) const {
  List out{};
  for (uint32_t o = 0; o < observations_; ++o)
    out[o] = planes[planes.size() - observations_ + o].data();
  return out;
}

void WeightEstimator::begin_component(const Planes& planes) {
  make_equations();
  if (observations_ == kObservations) end_list(planes);
}

// As late as can be: after the last component that anything is solved for, rows need not learn.
void WeightEstimator::end_list(const Planes& planes) {
  const List observed = list(planes);
  parallel_ranges(graph_.size(), threads_, [&](uint32_t begin, uint32_t end) {
    for (uint32_t r = begin; r < end; ++r) {
      if (misses_[r] > 0) fold(r, observed);
    }
  });
  std::fill(folded_.begin(), folded_.end(), uint8_t{0});
  observations_ = 0;
}

void WeightEstimator::fold(uint32_t r, const List& list) {
  const PredictionGraph::Row& row = graph_.rows[r];
  if (folded_[r] == observations_) return;
  kernels_.fold(
      equations_[r], options_.sum_to_one ? nullptr : targets_[r].data(),
      {list.data(), scale_, row.neighbour.data(), row.count, r, folded_[r], observations_});
  folded_[r] = static_cast<uint8_t>(observations_);
}

void WeightEstimator::fade(double factor, const Planes& planes) {
  end_list(planes);
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    stop_.check();
    for (auto& strip : equations_[r].strip) {
      for (double& entry : strip) entry *= factor;
    }
    if (options_.sum_to_one) continue;
    for (double& entry : targets_[r]) entry *= factor;
  }
  std::fill(misses_.begin(), misses_.end(), kNeverSolved);
}

void WeightEstimator::solve(uint32_t misses, const Planes& planes) {
  make_equations();
  const List observed = list(planes);
  const std::vector<uint32_t> rows = take_missed(misses);
  const auto eights = static_cast<uint32_t>((rows.size() + kRowsAtOnce - 1) / kRowsAtOnce);
  parallel_ranges(eights, threads_, [&](uint32_t begin, uint32_t end) {
    for (uint32_t first = begin * kRowsAtOnce; first < end * kRowsAtOnce; first += kRowsAtOnce) {
      stop_.check();
      solve_eight(rows, first, observed);
    }
  });
}

std::vector<uint32_t> WeightEstimator::take_missed(uint32_t misses) {
  std::vector<uint32_t> rows;
  for (const uint32_t r : by_count_) {
    if (misses_[r] < misses) continue;
    rows.push_back(r);
    misses_[r] = 0;
  }
  return rows;
}

void WeightEstimator::solve_eight(const std::vector<uint32_t>& rows, uint32_t first,
                                  const List& list) {
  const uint32_t count = std::min(kRowsAtOnce, static_cast<uint32_t>(rows.size()) - first);
  float dropped[kMaxNeighbours];
  uint32_t row[kRowsAtOnce];
  float* out[kRowsAtOnce];
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
    // Past the end the last row comes again; its results are dropped.
    row[l] = rows[first + std::min(l, count - 1)];
    out[l] = l < count ? &weights_[size_t{row[l]} * kMaxNeighbours] : dropped;
  }
  if (borrowed_) {
    solve_anew(row, list, out);
    return;
  }
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
    if (first + l + 1 < rows.size()) {
      prefetch(graph_.rows[rows[first + l + 1]]);
      prefetch(equations_[rows[first + l + 1]]);
    }
    if (l < count) fold(row[l], list);
  }
  kernels_.solve(task(graph_.rows.data(), equations_.data()), row, out);
}

void WeightEstimator::solve_anew(const uint32_t row[kRowsAtOnce], const List& list,
                                 float* const* out) const {
  RowEquations equations[kRowsAtOnce];
  RowEquations* to[kRowsAtOnce];
  PredictionGraph::Row rows[kRowsAtOnce];
  uint32_t places[kRowsAtOnce];
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
    to[l] = &equations[l];
    rows[l] = graph_.rows[row[l]];
    places[l] = l;
  }
  observe_rows(graph_, borrowed_->points, *borrowed_->order, row, kernels_, to);
  for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
    const PredictionGraph::Row& r = rows[l];
    kernels_.fold(equations[l], nullptr,
                  {list.data(), scale_, r.neighbour.data(), r.count, row[l], 0, observations_});
  }
  kernels_.solve(task(rows, equations), places, out);
}

SolveTask WeightEstimator::task(const PredictionGraph::Row* rows,
                                const RowEquations* equations) const {
  const double ring = options_.ring_deviation;
  const double extra = options_.extra_deviation;
  return {rows, equations, options_.sum_to_one ? nullptr : targets_.data(), 1 / (ring * ring),
          1 / (extra * extra)};
}

}  // namespace reeb
