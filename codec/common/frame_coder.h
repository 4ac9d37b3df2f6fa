// Lossless coding of a group's frames, one after another and row by row. Encoder and decoder run
// this same code.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/common/displacement_predictor.h"
#include "codec/common/mesh_state.h"
#include "codec/common/number_set.h"
#include "codec/common/prediction_graph.h"
#include "codec/common/rank_model.h"

namespace reeb {

/// Set of each axis' numbers.
using NumberSets = std::array<NumberSet, 3>;

class FrameCoder {
 public:
  /// `quick`: fewer neighbours that are learned from less often, and no mixing.
  /// `graph` must outlive the coder; `start`: [row][xyz] of the reference mesh, finite.
  FrameCoder(const PredictionGraph& graph, const std::vector<float>& start, const NumberSets& sets,
             bool quick, unsigned threads);

  /// Codes the next frame, [row][xyz]: reads it with encoders, writes it with decoders. False when
  /// a decoder meets what no encoder writes.
  template <class Bits, class Raw>
  bool code(Bits& bits, Raw& raw, float* frame) {
    for (uint32_t row = 0; row < graph_.size(); ++row) {
      if (!code_row(bits, raw, row, frame + size_t{row} * 3)) return false;
    }
    predictor_.finish_frame();
    ++frames_;
    return true;
  }

  /// The next frame is predicted from this one, which is a copy of one already coded.
  void jump(const std::vector<float>& frame) { predictor_.jump(frame); }

 private:
  /// Of a row and axis: sizes in world units (see `DifferenceContext`), and signs.
  struct Trace {
    std::array<int16_t, 4> size{};
    std::array<int16_t, 4> older{};
    std::array<int8_t, 4> sign{};
    uint8_t still = 0;  ///< frames without motion, up to kLongStill
  };

  template <class Bits, class Raw>
  bool code_row(Bits& bits, Raw& raw, uint32_t row, float* xyz) {
    const std::array<double, 3> predicted = predictor_.predict(row);
    const float* last = predictor_.last(row);
    const bool same = still_[still_context(row)].code(bits, equal(xyz, last), kStillLimit);
    Trace& trace = traces_[row];
    if (same) {
      trace.still = static_cast<uint8_t>(std::min<uint32_t>(trace.still + 1u, kLongStill));
      std::copy_n(last, 3, xyz);
    } else {
      trace.still = 0;
      gather(row);
      for (uint32_t a = 0; a < 3; ++a) {
        if (!code_coordinate(bits, raw, row, a, predicted[a], xyz[a])) return false;
      }
    }
    predictor_.place(row, xyz, predicted);
    return true;
  }

  template <class Bits, class Raw>
  bool code_coordinate(Bits& bits, Raw& raw, uint32_t row, uint32_t axis, double predicted,
                       float& x) {
    const NumberSet& set = sets_[axis];
    const int64_t guess = set.nearest(predicted);
    const int32_t unit = set.spacing(guess);
    const DifferenceContext c = context(row, axis, unit);
    bool member = true;
    int64_t n = 0;
    if constexpr (!kDecodes<Bits>) n = set.find(x, member) - guess;
    const bool difference = quick_ ? quick_model_.code(bits, raw, c, !member, n)
                                   : model_.code(bits, raw, c, !member, n);
    if (!difference) {
      x = std::bit_cast<float>(raw.code(std::bit_cast<uint32_t>(x), 32));
      n = 0;
      if (!std::isfinite(x)) return false;
    } else if constexpr (kDecodes<Bits>) {
      if (!set.valid(guess + n)) return false;
      x = set.number(guess + n);
    }
    note(row, axis, unit, n);
    return true;
  }

  static bool equal(const float* a, const float* b) {
    for (int i = 0; i < 3; ++i) {
      if (std::bit_cast<uint32_t>(a[i]) != std::bit_cast<uint32_t>(b[i])) return false;
    }
    return true;
  }

  uint32_t still_context(uint32_t row) const;
  /// Puts together what the neighbours tell of a row.
  void gather(uint32_t row);
  DifferenceContext context(uint32_t row, uint32_t axis, int32_t unit) const;
  void note(uint32_t row, uint32_t axis, int32_t unit, int64_t n);

  static constexpr uint32_t kLongStill = 7;
  static constexpr uint32_t kStillLimit = 1000;

  const PredictionGraph& graph_;
  NumberSets sets_;
  DisplacementPredictor predictor_;
  bool quick_;
  RankModel model_;
  QuickRankModel quick_model_;
  AdaptiveBit still_[(kLongStill + 1) * 3 * 3];
  std::vector<Trace> traces_;
  std::array<int32_t, 3> ring_{};  ///< of the row in hand: mean size over the neighbours, by axis
  std::array<int32_t, 3> running_{};  ///< decaying mean size over the rows, times 16
  uint32_t frames_ = 0;
};

}  // namespace reeb
