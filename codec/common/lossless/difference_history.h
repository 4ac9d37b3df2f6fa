// What earlier differences of lossless coding tell about the next one.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "codec/common/lossless/rank_model.h"
#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

/// Sizes and signs of every row's differences and how long each row has been still. For every row:
/// `note_still`, or `open_row` and then, axis by axis, `context` and `note`. Inline, since a sixth
/// of the time goes here.
class DifferenceHistory {
 public:
  static constexpr uint32_t kLongStill = 7;  ///< frames counted at most
  static constexpr uint32_t kStillContexts = (kLongStill + 1) * 3 * 3;

  /// `graph` must outlive the history.
  explicit DifferenceHistory(const PredictionGraph& graph);

  /// Whether the row has been still, and its first two neighbours are: below kStillContexts.
  uint32_t still_context(uint32_t row) const {
    const PredictionGraph::Row& r = graph_.rows[row];
    const auto state = [&](uint32_t i) {
      if (i >= r.count) return 2u;
      return traces_[r.neighbour[i]].still > 0 ? 1u : 0u;
    };
    return (traces_[row].still * 3 + state(0)) * 3 + state(1);
  }

  void note_still(uint32_t row) {
    Trace& own = traces_[row];
    own.still = static_cast<uint8_t>(std::min<uint32_t>(own.still + 1u, kLongStill));
  }

  /// The row moves: puts together what its neighbours tell.
  void open_row(uint32_t row) {
    const PredictionGraph::Row& r = graph_.rows[row];
    const auto count = static_cast<int32_t>(std::min<uint32_t>(r.count, kNear));
    traces_[row].still = 0;
    ring_ = {0, 0, 0};
    for (int32_t i = 0; i < count; ++i) {
      for (uint32_t a = 0; a < 3; ++a) ring_[a] += traces_[r.neighbour[i]].size[a];
    }
    for (uint32_t a = 0; a < 3; ++a) ring_[a] = count > 0 ? ring_[a] / count : running(a);
  }

  /// `unit`: log size of a difference of 1 here, in world units; `first`: the first frame is coded.
  DifferenceContext context(uint32_t row, uint32_t axis, int32_t unit, bool first) const {
    const PredictionGraph::Row& r = graph_.rows[row];
    const Trace& own = traces_[row];
    const Trace& nearest = traces_[r.neighbour[0]];
    DifferenceContext c;
    c.before = own.size[axis] - unit;
    c.older = own.older[axis] - unit;
    c.ring = ring_[axis] - unit;
    c.nearest = nearest.size[axis] - unit;
    c.axis_before = (axis > 0 ? own.size[axis - 1] : running(axis)) - unit;
    const int32_t near = 4 * c.before + 2 * c.older + 6 * c.ring;
    const int32_t all = first      ? c.ring
                        : axis > 0 ? (near + 4 * c.axis_before) / 16
                                   : (near + c.axis_before) / 13;
    c.expected = std::max(all, 0);
    c.axis = axis;
    c.coarseness = coarseness_[row];
    c.sign_before = int32_t{own.sign[axis]};
    c.sign_nearest = r.count > 0 ? nearest.sign[axis] : 0;
    c.sign_next = r.count > 1 ? traces_[r.neighbour[1]].sign[axis] : 0;
    return c;
  }

  void note(uint32_t row, uint32_t axis, int32_t unit, int64_t n) {
    Trace& own = traces_[row];
    own.older[axis] = own.size[axis];
    own.size[axis] = static_cast<int16_t>(log_size(n) + unit);
    own.sign[axis] = static_cast<int8_t>(n < 0 ? -1 : n > 0 ? 1 : 0);
    running_[axis] += own.size[axis] - running(axis);
  }

 private:
  static constexpr uint32_t kNear = 4;     ///< neighbours that make the contexts
  static constexpr int32_t kRunning = 16;  ///< rows over which the running mean fades

  /// Of a row, by axis: sizes in world units (see `DifferenceContext`) and signs.
  struct Trace {
    std::array<int16_t, 4> size{};
    std::array<int16_t, 4> older{};
    std::array<int8_t, 4> sign{};
    uint8_t still = 0;  ///< frames without motion
  };

  int32_t running(uint32_t axis) const { return running_[axis] / kRunning; }

  const PredictionGraph& graph_;
  std::vector<Trace> traces_;
  std::vector<uint8_t> coarseness_;  ///< of each row, see DifferenceContext
  std::array<int32_t, 3> ring_{};    ///< of the row in hand: mean size over the neighbours, by axis
  std::array<int32_t, 3> running_{};  ///< decaying mean size over the rows, times kRunning
};

}  // namespace reeb
