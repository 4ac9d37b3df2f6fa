// Coder of integers that several guesses predict.
//
// A guess is a place and a scale; how far the truth lies from the guesses of one kind, and how
// often that kind is right, is learned while coding. The distributions of all guesses are added,
// and the integer is found by halving its range. Integer arithmetic throughout.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "entropy/range_coder.h"

namespace reeb {

/// Learned density of the signed error of one kind of guess. Errors come in 1/16 of a step; the
/// density is constant over each of the eight steps next to 0 and over quarters of octaves beyond.
class ErrorModel {
 public:
  static constexpr uint32_t kUnit = 1 << 12;  ///< one observation

  ErrorModel();
  /// Weight of the errors from 0 to `error`, negative where `error` is; at most 2^40.
  int64_t weight_to(int64_t error) const;
  /// Learns that a guess of this kind was there and explains `share` (0 .. kUnit) of a truth at
  /// `error`. Beyond `memory` observations (up to 4096) all are halved.
  void observe(int64_t error, uint32_t share, uint32_t memory);

 private:
  static constexpr uint32_t kBlock = 16;
  static constexpr uint32_t kBlocks = 9;
  static constexpr uint32_t kBuckets = kBlock * kBlocks;
  using Weights = std::array<uint32_t, kBuckets>;

  /// Errors of one sign, summed up at two levels, so that both looking up and adding are quick.
  struct Side {
    std::array<uint32_t, kBlocks> blocks;                         // all blocks before
    std::array<std::array<uint32_t, kBlock + 1>, kBlocks> inner;  // before each bucket of a block
    void add(uint32_t bucket, uint32_t share);
    void sum_up(const Weights& weights);
    Weights weights() const;
  };
  struct Bucket {
    uint32_t index;
    uint32_t width_log2;
  };
  /// Bucket of an error without its sign, < 2^41; it begins at a multiple of its width.
  static Bucket bucket_of(uint64_t error) {
    const uint32_t width_log2 = static_cast<uint32_t>(std::bit_width(error | 64)) - 3;
    return {4 * (width_log2 - 4) + static_cast<uint32_t>(error >> width_log2), width_log2};
  }
  void halve();

  Side sides_[2];  // errors >= 0, errors < 0
  uint32_t seen_;
  uint64_t scale_ = 0;
};

inline int64_t ErrorModel::weight_to(int64_t error) const {
  const int64_t sign = error >> 63;  // -1 or 0: no branch, which nobody could foresee
  const auto size = static_cast<uint64_t>((error ^ sign) - sign);
  const Bucket b = bucket_of(size);
  const Side& side = sides_[sign & 1];
  const uint32_t block = b.index / kBlock;
  const uint32_t* const inner = &side.inner[block][b.index % kBlock];
  const uint64_t beyond = size & ((uint64_t{1} << b.width_log2) - 1);
  const uint64_t part = (beyond * (uint64_t{inner[1] - inner[0]} << 8)) >> b.width_log2;
  const uint64_t before = side.blocks[block] + inner[0];
  const auto weight = static_cast<int64_t>(((before << 8) + part) * scale_);
  return (weight ^ sign) - sign;
}

/// Adds up guesses of the kinds 0 .. kinds-1; see ErrorModel::observe for `memory`.
class GuessMixture {
 public:
  GuessMixture(uint32_t kinds, uint32_t memory) : memory_(memory), models_(kinds) {}

  void clear() { guesses_.clear(); }

  /// `place` in 1/256; one step of the error model is 1/8 of `scale`, which is in 1/256 too, 1 ..
  /// 2^24.
  void add(uint32_t kind, int64_t place, uint32_t scale) {
    guesses_.push_back({&models_[kind], place, (int64_t{1} << 23) / scale});
  }

  /// Codes `value` in 0 .. count-1 and learns it. The guesses see value v as the interval [v, v+1).
  /// The range is split at `likely` (< count) first, then at distances reach, 2 reach, ... (reach >
  /// 0) beyond until the value is passed, then in halves.
  template <class Coder>
  uint32_t code(Coder& coder, uint32_t value, uint32_t count, uint32_t likely, uint64_t reach) {
    for (auto* weights : {&low_, &high_, &split_}) weights->resize(guesses_.size());
    Range r = {0, count, weigh(0, low_), weigh(count, high_)};
    const bool up = likely == 0 || narrow(coder, value, likely, r);
    bool passed = false;
    for (uint64_t split = likely; !passed && reach < (up ? r.last - split : split - r.first);
         reach *= 2) {
      split = up ? split + reach : split - reach;
      passed = narrow(coder, value, static_cast<uint32_t>(split), r) != up;
    }
    while (r.last - r.first > 1) narrow(coder, value, r.first + (r.last - r.first) / 2, r);
    observe(r.first, static_cast<uint64_t>(r.high - r.low));
    return r.first;
  }

 private:
  struct Range {
    uint32_t first, last;  // the value is in [first, last)
    int64_t low, high;     // weight below each
  };

  template <class Coder>
  bool narrow(Coder& coder, uint32_t value, uint32_t split, Range& r) {
    const int64_t weight = weigh(split, split_);
    const bool up = coder.code(value >= split, probability(r.high - weight, r.high - r.low));
    (up ? r.first : r.last) = split;
    (up ? r.low : r.high) = weight;
    (up ? low_ : high_).swap(split_);
    return up;
  }

  struct Guess {
    ErrorModel* model;
    int64_t place;
    int64_t gain;  // steps of the error model per unit of distance
    /// Of `value` plus `part` / 256.
    int64_t error(uint32_t value, int64_t part = 0) const {
      return ((static_cast<int64_t>(value) << 8) + part - place) * gain >> 16;
    }
  };

  static Probability probability(int64_t part, int64_t whole);
  /// Weight of all values below `value`, up to a constant, by guess and in all; rises by at least
  /// kFloor per value.
  int64_t weigh(uint32_t value, std::vector<int64_t>& by_guess) const {
    int64_t sum = kFloor * value;
    for (size_t i = 0; i < guesses_.size(); ++i) {
      by_guess[i] = guesses_[i].model->weight_to(guesses_[i].error(value));
      sum += by_guess[i];
    }
    return sum;
  }
  /// Learns `value`; low_ and high_ are the weights below it and below the next.
  void observe(uint32_t value, uint64_t all);

  static constexpr int64_t kFloor = 1 << 8;
  uint32_t memory_;
  std::vector<Guess> guesses_;
  std::vector<ErrorModel> models_;
  std::vector<int64_t> low_, high_, split_;  // weights by guess below the bounds of the range
};

}  // namespace reeb
