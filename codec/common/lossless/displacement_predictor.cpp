#include "codec/common/lossless/displacement_predictor.h"

#include <algorithm>

#include "codec/common/base/batches.h"
#include "codec/common/base/parallel.h"
#include "codec/common/lossless/displacement_kernels.h"
#include "codec/common/simd/instruction_set.h"

namespace reeb {

struct DisplacementPredictor::Batches {
  BatchVector<DisplacementBatch> items;
  DisplacementKernels kernels = fastest_kernels<DisplacementKernels>();
};

namespace {

constexpr double kAloneWeight = 0.8;       ///< of the last displacement where there is no neighbour
constexpr uint32_t kFirstFrames = 8;       ///< that are all learned from
constexpr float kMaxDisplacement = 1e37f;  ///< displacements are cut there: sums stay finite

void init_row(DisplacementBatch& batch, uint32_t place, uint32_t r, uint32_t terms,
              const PredictionGraph::Row& row) {
  batch.self[place] = r;
  batch.count = std::max(batch.count, kOwnTerms + terms);
  for (uint32_t i = 0; i < kMaxNeighbours; ++i) {
    const bool own = i < kOwnTerms;
    const uint32_t n = i - kOwnTerms;
    const bool used = own || n < terms;
    batch.neighbour[i][place] = !own && used ? row.neighbour[n] : r;
    batch.in_use[i][place] = used ? 1.0 : 0.0;
    batch.prior[i][place] = !own && used ? static_cast<double>(row.prior[n]) : 0.0;
  }
  if (terms == 0) batch.prior[0][place] = kAloneWeight;
}

}  // namespace

DisplacementPredictor::DisplacementPredictor(const PredictionGraph& graph,
                                             const std::vector<float>& start,
                                             const DisplacementOptions& options, unsigned threads,
                                             const StopToken& stop)
    : graph_(graph),
      options_(options),
      threads_(threads),
      stop_(stop),
      batches_(std::make_unique<Batches>()),
      weights_(size_t{graph.size()} * kMaxNeighbours, 0.0f),
      position_(size_t{graph.size()} * 4),
      squared_error_(graph.size()) {
  for (auto& plane : moved_) plane.assign(position_.size(), 0.0f);
  make_batches((graph.size() + kRowsAtOnce - 1) / kRowsAtOnce, stop, batches_->items);
  for (uint32_t r = 0; r < batches_->items.size() * kRowsAtOnce; ++r) {
    // Past the end the last row comes again; its results are dropped.
    const uint32_t row = std::min(r, graph.size() - 1);
    init_row(batches_->items[r / kRowsAtOnce], r % kRowsAtOnce, row, terms(row), graph.rows[row]);
  }
  jump(start);
  solve();
}

DisplacementPredictor::~DisplacementPredictor() = default;

void DisplacementPredictor::jump(const std::vector<float>& frame) {
  for (uint32_t r = 0; r < graph_.size(); ++r) {
    std::copy_n(&frame[size_t{r} * 3], 3, &position_[size_t{r} * 4]);
  }
  for (auto& plane : moved_) std::fill(plane.begin(), plane.end(), 0.0f);
}

std::array<double, 3> DisplacementPredictor::predict(uint32_t row) const {
  const float* w = &weights_[size_t{row} * kMaxNeighbours];
  const auto& neighbour = graph_.rows[row].neighbour;
  const uint32_t count = terms(row);
  double sum[4] = {0, 0, 0, 0};  // four, so that vector units may take them all
  const auto add = [&](const float* moved, float weight) {
    for (uint32_t a = 0; a < 4; ++a)
      sum[a] += static_cast<double>(moved[a]) * static_cast<double>(weight);
  };
  add(&moved_[1][size_t{row} * 4], w[0]);
  add(&moved_[2][size_t{row} * 4], w[1]);
  for (uint32_t i = 0; i < count; ++i) add(&moved_[0][size_t{neighbour[i]} * 4], w[kOwnTerms + i]);
  add(&position_[size_t{row} * 4], 1.0f);
  return {sum[0], sum[1], sum[2]};
}

void DisplacementPredictor::place(uint32_t row, const float xyz[3],
                                  const std::array<double, 3>& predicted) {
  float* position = &position_[size_t{row} * 4];
  float* moved = &moved_[0][size_t{row} * 4];
  double square = 0;
  for (size_t a = 0; a < 3; ++a) {
    const double e = static_cast<double>(xyz[a]) - predicted[a];
    square += e * e;
    moved[a] = std::clamp(xyz[a] - position[a], -kMaxDisplacement, kMaxDisplacement);
    position[a] = xyz[a];
  }
  squared_error_[row] = square;
}

// The first frame starts from the reference mesh: what it is away from there is no motion.
bool DisplacementPredictor::learns() const {
  return frames_ > 0 && (frames_ < kFirstFrames || frames_ % options_.period == 0);
}

void DisplacementPredictor::finish_frame() {
  if (learns()) {
    learn();
    solve();
  }
  if (frames_++ == 0) return;
  std::swap(moved_[1], moved_[2]);
  std::swap(moved_[0], moved_[1]);
}

void DisplacementPredictor::learn() {
  const DisplacementFrame frame = {moved_[0].data(), moved_[1].data(), moved_[2].data(),
                                   squared_error_.data()};
  const auto count = static_cast<uint32_t>(batches_->items.size());
  parallel_ranges(count, threads_, [&](uint32_t begin, uint32_t end) {
    for (uint32_t b = begin; b < end; ++b) {
      stop_.check();
      batches_->kernels.learn(batches_->items[b], frame);
    }
  });
}

void DisplacementPredictor::solve() {
  float dropped[kMaxNeighbours];
  const auto count = static_cast<uint32_t>(batches_->items.size());
  parallel_ranges(count, threads_, [&](uint32_t begin, uint32_t end) {
    for (uint32_t b = begin; b < end; ++b) {
      stop_.check();
      float* out[kRowsAtOnce];
      for (uint32_t l = 0; l < kRowsAtOnce; ++l) {
        const uint32_t row = b * kRowsAtOnce + l;
        out[l] = row < graph_.size() ? &weights_[size_t{row} * kMaxNeighbours] : dropped;
      }
      batches_->kernels.solve(batches_->items[b], out);
    }
  });
}

}  // namespace reeb
