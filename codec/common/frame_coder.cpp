#include "codec/common/frame_coder.h"

#include <algorithm>

namespace reeb {

namespace {

constexpr DisplacementOptions kQuickPrediction = {.neighbours = 6, .period = 4};
constexpr uint32_t kNear = 4;            ///< neighbours that make the contexts
constexpr uint32_t kRunning = 16;        ///< rows over which the running mean fades
constexpr int32_t kUsualSize = 8 * 140;  ///< expected before anything is known

}  // namespace

FrameCoder::FrameCoder(const PredictionGraph& graph, const std::vector<float>& start,
                       const NumberSets& sets, bool quick, unsigned threads)
    : graph_(graph),
      sets_(sets),
      predictor_(graph, start, quick ? kQuickPrediction : DisplacementOptions(), threads),
      quick_(quick),
      traces_(graph.size()) {
  for (Trace& t : traces_) {
    t.size.fill(kUsualSize);
    t.older.fill(kUsualSize);
  }
  running_.fill(kUsualSize * static_cast<int32_t>(kRunning));
}

uint32_t FrameCoder::still_context(uint32_t row) const {
  const PredictionGraph::Row& r = graph_.rows[row];
  const auto state = [&](uint32_t i) {
    if (i >= r.count) return 2u;
    return traces_[r.neighbour[i]].still > 0 ? 1u : 0u;
  };
  return (traces_[row].still * 3 + state(0)) * 3 + state(1);
}

void FrameCoder::gather(uint32_t row) {
  const PredictionGraph::Row& r = graph_.rows[row];
  const uint32_t count = std::min<uint32_t>(r.count, kNear);
  for (uint32_t a = 0; a < 3; ++a) {
    if (count == 0) {
      ring_[a] = running_[a] / static_cast<int32_t>(kRunning);
      continue;
    }
    int32_t sum = 0;
    for (uint32_t i = 0; i < count; ++i) sum += traces_[r.neighbour[i]].size[a];
    ring_[a] = sum / static_cast<int32_t>(count);
  }
}

DifferenceContext FrameCoder::context(uint32_t row, uint32_t axis, int32_t unit) const {
  const PredictionGraph::Row& r = graph_.rows[row];
  const Trace& own = traces_[row];
  const Trace& first = traces_[r.neighbour[0]];
  const Trace& second = traces_[r.neighbour[1]];
  const int32_t running = running_[axis] / static_cast<int32_t>(kRunning);
  DifferenceContext c;
  c.before = own.size[axis] - unit;
  c.older = own.older[axis] - unit;
  c.ring = ring_[axis] - unit;
  c.nearest = first.size[axis] - unit;
  c.axis_before = (axis > 0 ? own.size[axis - 1] : running) - unit;
  const int32_t all = frames_ == 0 ? c.ring
                      : axis > 0
                          ? (4 * c.before + 2 * c.older + 6 * c.ring + 4 * c.axis_before) / 16
                          : (4 * c.before + 2 * c.older + 6 * c.ring + c.axis_before) / 13;
  c.expected = std::max(all, 0);
  c.axis = axis;
  c.level = std::min(7u, log2_q5(std::max(1u, graph_.size() / (row + 1))) / 32);
  c.sign_before = own.sign[axis];
  c.sign_nearest = r.count > 0 ? first.sign[axis] : 0;
  c.sign_next = r.count > 1 ? second.sign[axis] : 0;
  return c;
}

void FrameCoder::note(uint32_t row, uint32_t axis, int32_t unit, int64_t n) {
  Trace& own = traces_[row];
  own.older[axis] = own.size[axis];
  own.size[axis] = static_cast<int16_t>(log_size(n) + unit);
  own.sign[axis] = static_cast<int8_t>(n < 0 ? -1 : n > 0 ? 1 : 0);
  running_[axis] += own.size[axis] - running_[axis] / static_cast<int32_t>(kRunning);
}

}  // namespace reeb
