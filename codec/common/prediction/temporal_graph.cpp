#include <algorithm>
#include <bit>

#include "codec/common/base/coding_tools.h"
#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

namespace {

using Row = PredictionGraph::Row;

/// A time of the hierarchy and the times it is predicted from, nearest first on either side.
struct Instant {
  uint32_t time = 0;
  std::vector<uint32_t> left;   ///< time - h, time - 3h
  std::vector<uint32_t> right;  ///< time + h, time + 3h
};

/// Every time once: 0, then the odd multiples of ever smaller powers of two.
std::vector<Instant> dyadic_order(uint32_t frames) {
  std::vector<Instant> out{{}};
  for (uint32_t h = std::bit_ceil(frames) / 2; h >= 1; h /= 2) {
    for (uint32_t t = h; t < frames; t += 2 * h) {
      Instant at{t, {t - h}, {}};
      if (t >= 3 * h) at.left.push_back(t - 3 * h);
      if (t + h < frames) at.right.push_back(t + h);
      if (t + 3 * h < frames) at.right.push_back(t + 3 * h);
      out.push_back(std::move(at));
    }
  }
  return out;
}

/// One time after another, each predicted from the two before it.
std::vector<Instant> sequential_order(uint32_t frames) {
  std::vector<Instant> out{{}};
  for (uint32_t t = 1; t < frames; ++t) {
    Instant at{t, {t - 1}, {}};
    if (t >= 2) at.left.push_back(t - 2);
    out.push_back(std::move(at));
  }
  return out;
}

/// Cubic interpolation where both sides have two times, linear where one is missing, extrapolation
/// at the end.
std::vector<float> interpolation_prior(const Instant& at) {
  const size_t l = at.left.size();
  const size_t r = at.right.size();
  std::vector<float> w(l + r, 0.0f);
  if (l == 2 && r == 2) return {9 / 16.0f, -1 / 16.0f, 9 / 16.0f, -1 / 16.0f};
  if (l > 0 && r > 0) {
    w[0] = w[l] = 0.5f;
  } else if (l == 2) {
    w = {1.5f, -0.5f};
  } else if (l == 1) {
    w = {1.0f};
  }
  return w;
}

class TemporalGraphBuilder {
 public:
  explicit TemporalGraphBuilder(uint32_t frames) : row_of_(size_t{frames} * 3) {}

  TemporalGraph build(const std::vector<Instant>& instants) {
    for (const Instant& at : instants) {
      for (uint32_t axis = 0; axis < 3; ++axis) add_row(at, axis);
    }
    out_.graph.step_index.assign(out_.graph.size(), 0);
    return std::move(out_);
  }

 private:
  void add_row(const Instant& at, uint32_t axis) {
    const auto r = static_cast<uint32_t>(out_.order.size());
    row_of_[at.time * 3 + axis] = r;
    out_.order.push_back(at.time * 3 + axis);
    Row row;
    row.neighbour.fill(r);
    row.prior.fill(0.0f);
    row.precision.fill(1.0f);
    const std::vector<float> prior = interpolation_prior(at);
    std::copy(prior.begin(), prior.end(), row.prior.begin());
    for (const uint32_t t : at.left) append(row, t, axis);
    for (const uint32_t t : at.right) append(row, t, axis);
    row.ring = row.count;
    for (uint32_t b = 0; b < axis; ++b) append(row, at.time, b);
    for (uint32_t b = 0; b < 3; ++b) {
      if (b != axis && !at.left.empty()) append(row, at.left[0], b);
    }
    out_.graph.rows.push_back(row);
  }

  void append(Row& row, uint32_t time, uint32_t axis) {
    row.neighbour[row.count++] = row_of_[time * 3 + axis];
  }

  std::vector<uint32_t> row_of_;
  TemporalGraph out_;
};

}  // namespace

TemporalGraph build_temporal_graph(uint32_t frames) {
  return TemporalGraphBuilder(frames).build(
      uses(coding_tool::kBasisHierarchy) ? dyadic_order(frames) : sequential_order(frames));
}

}  // namespace reeb
