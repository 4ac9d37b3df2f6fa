// Lossless coding of a group's frames, one after another and row by row. Encoder and decoder run
// this same code.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/common/lossless/difference_history.h"
#include "codec/common/lossless/displacement_predictor.h"
#include "codec/common/lossless/grid_syntax.h"
#include "codec/common/lossless/number_set.h"
#include "codec/common/lossless/rank_model.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/reference/mesh_state.h"

namespace reeb {

/// Set of each axis' numbers, and the grids of a frame.
using NumberSets = std::array<NumberSet, 3>;
using FrameGrids = std::array<FrameGrid, 3>;

class FrameCoder {
 public:
  /// `quick`: fewer neighbours that are learned from less often, and no mixing.
  /// `graph` must outlive the coder; `start`: [row][xyz] of the reference mesh, finite. Coding
  /// throws Stopped where `stop` is requested.
  FrameCoder(const PredictionGraph& graph, const std::vector<float>& start, const NumberSets& sets,
             bool quick, unsigned threads, const StopToken& stop = {});

  /// Codes the next frame, [row][xyz]: reads it with encoders, writes it with decoders; `grids` of
  /// the axes whose sets are those of frames, as an encoder wants them. False when a decoder meets
  /// what no encoder writes.
  template <class Bits, class Raw>
  bool code(Bits& bits, Raw& raw, float* frame, const FrameGrids& grids = {}) {
    const bool fine =
        code_grids(bits, raw, grids) &&
        (quick_ ? code_rows(bits, raw, quick_model_, frame) : code_rows(bits, raw, model_, frame));
    predictor_.finish_frame();
    first_ = false;
    return fine;
  }

  /// The next frame is predicted from this one, which is a copy of one already coded.
  void jump(const std::vector<float>& frame) { predictor_.jump(frame); }

 private:
  template <class Bits, class Raw>
  bool code_grids(Bits& bits, Raw& raw, const FrameGrids& wanted) {
    for (size_t a = 0; a < 3; ++a) {
      if (!by_frame_[a]) continue;
      FrameGrid& grid = grids_[a];
      if (!grid_syntax_[a].code(bits, raw, wanted[a], grid)) return false;
      sets_[a] = grid.count > 0 ? NumberSet::levels(grid) : NumberSet();
    }
    return true;
  }

  template <class Bits, class Raw, class Model>
  bool code_rows(Bits& bits, Raw& raw, Model& model, float* frame) {
    for (uint32_t row = 0; row < graph_.size(); ++row) {
      stop_.check();
      if (!code_row(bits, raw, model, row, frame + size_t{row} * 3)) return false;
    }
    return true;
  }

  template <class Bits, class Raw, class Model>
  bool code_row(Bits& bits, Raw& raw, Model& model, uint32_t row, float* xyz) {
    const std::array<double, 3> predicted = predictor_.predict(row);
    const float* last = predictor_.last(row);
    AdaptiveBit& still = still_[history_.still_context(row)];
    if (still.code(bits, equal(xyz, last), kStillLimit)) {
      history_.note_still(row);
      std::copy_n(last, 3, xyz);
    } else {
      history_.open_row(row);
      for (uint32_t a = 0; a < 3; ++a) {
        if (!code_coordinate(bits, raw, model, row, a, predicted[a], xyz[a])) return false;
      }
    }
    predictor_.place(row, xyz, predicted);
    return true;
  }

  template <class Bits, class Raw, class Model>
  bool code_coordinate(Bits& bits, Raw& raw, Model& model, uint32_t row, uint32_t axis,
                       double predicted, float& x) {
    const NumberSet& set = sets_[axis];
    const int64_t guess = set.nearest(predicted);
    const int32_t unit = set.spacing(guess);
    const DifferenceContext c = history_.context(row, axis, unit, first_);
    bool member = true;
    int64_t n = 0;
    if constexpr (!kDecodes<Bits>) n = set.difference(guess, set.find(x, member));
    if (!model.code(bits, raw, c, !member, n)) {
      x = std::bit_cast<float>(raw.code(std::bit_cast<uint32_t>(x), 32));
      n = 0;
      if (!std::isfinite(x)) return false;
    } else if constexpr (kDecodes<Bits>) {
      const int64_t at = set.moved(guess, n);
      if (!set.valid(at)) return false;
      x = set.number(at);
    }
    history_.note(row, axis, unit, n);
    return true;
  }

  static bool equal(const float* a, const float* b) {
    for (int i = 0; i < 3; ++i) {
      if (std::bit_cast<uint32_t>(a[i]) != std::bit_cast<uint32_t>(b[i])) return false;
    }
    return true;
  }

  static constexpr uint32_t kStillLimit = 1000;

  const PredictionGraph& graph_;
  StopToken stop_;
  NumberSets sets_;
  std::array<bool, 3> by_frame_;
  FrameGrids grids_;  ///< of the frame, of the axes whose sets are those of frames
  std::array<GridSyntax, 3> grid_syntax_;
  DisplacementPredictor predictor_;
  DifferenceHistory history_;
  bool quick_;
  bool first_ = true;  ///< no frame is coded yet
  RankModel model_;
  QuickRankModel quick_model_;
  AdaptiveBit still_[DifferenceHistory::kStillContexts];
};

}  // namespace reeb
