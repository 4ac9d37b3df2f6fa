// Coding of the corrections of a group: row after row of the surface graph, each with all its
// frames, so that a row sees its neighbours' corrections before, at and after every frame. Encoder
// and decoder run this same code.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/synthesis/corrections.h"
#include "entropy/integer_coder.h"
#include "entropy/mixer.h"

namespace reeb {

class CorrectionField {
 public:
  /// `count`: corrections that there will be at most, where that is known.
  CorrectionField(const PredictionGraph& graph, uint32_t frames, uint64_t count = 0);

  /// Bytes of memory while a group is coded.
  static uint64_t memory(uint64_t rows, uint64_t frames, uint64_t count) {
    return rows * (sizeof(size_t) + sizeof(uint32_t)) + 3 * kPlaceBytes * (frames + kMargin) +
           sizeof(uint32_t) * count + sizeof(CorrectionField);
  }

  /// Codes the rows in order. `get(row, t, axis)` gives a coordinate's correction (asked for only
  /// by an encoder's coder, whose first argument counts), `put(row, t, axis, correction)` takes
  /// each one that is not none; false from it ends the coding.
  template <class Coder, class Get, class Put>
  bool code(Coder& coder, Get&& get, Put&& put) {
    for (uint32_t row = 0; row < graph_.size(); ++row) {
      const RowSource<Get> source{get, row, frames_};
      if (!code_row(coder, source, put)) return false;
    }
    return true;
  }

 private:
  static constexpr uint32_t kBefore = 2;  ///< frames of zeros before the first
  static constexpr uint32_t kMargin = 3;  ///< those, and one after the last
  static constexpr int kZeroTables = 6;
  static constexpr int kSignTables = 3;
  static constexpr uint32_t kLengths = 53;  ///< of a number of steps; the next means replaced
  static constexpr uint32_t kLimit = 500;
  using ZeroMixer = BitMixer<kZeroTables>;
  using SignMixer = BitMixer<kSignTables>;

  template <class Get>
  struct RowSource {
    Get& get;
    uint32_t row;
    uint32_t frames;
    Correction at(uint32_t t, uint32_t axis) const { return get(row, t, axis); }
    bool any() const {
      for (uint32_t i = 0; i < 3 * frames; ++i) {
        if (!at(i / 3, i % 3).none()) return true;
      }
      return false;
    }
  };

  /// Where in the row's arrays coordinate `axis` of frame t lies.
  static size_t place(uint32_t t, uint32_t axis) { return size_t{3} * (t + kBefore) + axis; }

  template <class Coder, class Source, class Put>
  bool code_row(Coder& coder, const Source& source, Put& put) {
    begin_row(source.row);
    if (active_[active_context_].code(coder, source.any())) {
      look_around(source.row);
      for (uint32_t t = 0; t < frames_; ++t) {
        for (uint32_t axis = 0; axis < 3; ++axis) {
          const Correction c = code_one(coder, source.at(t, axis), place(t, axis), axis);
          note(c, place(t, axis));
          if (!c.none() && !put(source.row, t, axis, c)) return false;
        }
      }
    }
    finish_row();
    return true;
  }

  template <class Coder>
  Correction code_one(Coder& coder, const Correction& wanted, size_t at, uint32_t axis) {
    const ZeroMixer::Prediction some = predict_some(at, axis);
    const bool is_some = coder.code(!wanted.none(), some.p1);
    zero_.update(some, is_some);
    if (!is_some) return {};
    const uint32_t length = code_length(coder, wanted, at);
    Correction out;
    out.replaced = length == kLengths;
    if (out.replaced) {
      const uint64_t bits = code_evenly(coder, 32, std::bit_cast<uint32_t>(wanted.value));
      out.value = std::bit_cast<float>(static_cast<uint32_t>(bits));
      return out;
    }
    const auto size = static_cast<uint64_t>(wanted.steps < 0 ? -wanted.steps : wanted.steps);
    const uint64_t low = uint64_t{1} << length;
    out.steps = static_cast<int64_t>(low | code_evenly(coder, length, size & (low - 1)));
    const SignMixer::Prediction negative = predict_negative(at);
    const bool is_negative = coder.code(wanted.steps < 0, negative.p1);
    sign_.update(negative, is_negative);
    if (is_negative) out.steps = -out.steps;
    return out;
  }

  /// Bits of the number of steps below its leading one; kLengths where it is replaced.
  template <class Coder>
  uint32_t code_length(Coder& coder, const Correction& wanted, size_t at) {
    const auto size = static_cast<uint64_t>(wanted.steps < 0 ? -wanted.steps : wanted.steps);
    const uint32_t full =
        wanted.replaced ? kLengths : static_cast<uint32_t>(std::bit_width(size | 1)) - 1;
    return code_unary(coder, length_[length_context(at)], full);
  }

  void begin_row(uint32_t row);
  /// What an active row sees of its neighbours.
  void look_around(uint32_t row);
  void finish_row();
  void note(const Correction& coded, size_t at);
  ZeroMixer::Prediction predict_some(size_t at, uint32_t axis) const;
  SignMixer::Prediction predict_negative(size_t at) const;
  uint32_t length_context(size_t at) const;
  bool has_some(uint32_t row) const { return first_[row] < first_[row + 1]; }

  /// A correction that is coded: its place, and its steps clamped to +-2.
  class Coded {
   public:
    Coded(size_t place, int64_t steps)
        : packed_(static_cast<uint32_t>(place << 3 | static_cast<uint64_t>(steps + 2))) {}
    uint32_t place() const { return packed_ >> 3; }
    int steps() const { return static_cast<int>(packed_ & 7) - 2; }

   private:
    uint32_t packed_;
  };
  /// Of frame_rate_, own_ and what near_ things there are.
  static constexpr uint64_t kPlaceBytes = 8;

  const PredictionGraph& graph_;
  uint32_t frames_;
  size_t row_size_;
  std::vector<Coded> coded_;          ///< row after row
  std::vector<size_t> first_;         ///< of each row; the end of the last one behind them
  std::vector<uint32_t> density_;     ///< of the row: share of corrected coordinates, 1/65536
  std::vector<uint32_t> frame_rate_;  ///< by place: decaying share over the active rows, 1/65536

  // Of the row being coded.
  std::vector<int8_t> own_;          ///< by place: steps clamped to +-2
  std::vector<uint8_t> near_size_;   ///< by place: sizes among the neighbours, the ring twice
  std::vector<int8_t> near_sum_;     ///< the same with signs
  std::vector<uint8_t> near_class_;  ///< class of the mean of near_size_
  uint32_t row_rate_ = 0;            ///< decaying share within the row, 1/65536
  uint32_t near_density_ = 0;        ///< class of the neighbours' mean density
  uint32_t active_context_ = 0;

  ZeroMixer zero_;
  SignMixer sign_;
  std::array<AdaptiveBit, 10> active_;
  std::array<std::array<AdaptiveBit, kLengths>, 4> length_;
};

}  // namespace reeb
