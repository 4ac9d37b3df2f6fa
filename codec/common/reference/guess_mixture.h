// Coder of integers that several guesses predict.
//
// A guess is a place and a scale; how far the truth lies from the guesses of one kind, and how
// often that kind is right, is learned while coding. The distributions of all guesses are added,
// and the integer is coded as an interval of the sum. Integer arithmetic throughout.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "entropy/interval_coder.h"

namespace reeb {

/// Learned density of the signed error of one kind of guess. Errors come in 1/16 of a step; the
/// density is constant over each of the eight steps next to 0 and over quarters of octaves beyond.
class ErrorModel {
 public:
  static constexpr uint32_t kUnit = 1 << 12;  ///< one observation

  ErrorModel();
  /// What looking up takes, until the model learns.
  class Reader;
  Reader reader() const;
  /// Learns that a guess of this kind was there and explains `share` (0 .. kUnit) of a truth at
  /// `error`. Beyond `memory` observations (up to 2048) all are halved.
  void observe(int64_t error, uint32_t share, uint32_t memory);

 private:
  static constexpr uint32_t kBlock = 16;
  static constexpr uint32_t kBlocks = 9;
  static constexpr uint32_t kBuckets = kBlock * kBlocks;
  static const std::array<uint32_t, 2 * kBlock> kAfter;

  /// Weights of the errors of one sign, in 1/256, summed up twice, in blocks and within, so that
  /// both looking up and adding are quick.
  struct Side {
    std::array<uint32_t, kBlocks + 3> blocks;  // all blocks before; some more to fill up vectors
    std::array<uint32_t, kBuckets> before;     // the buckets before of the same block
    std::array<uint32_t, kBuckets> weights;
    void add(uint32_t bucket, uint32_t weight);
    void sum_up();
    /// From 0 to an error of `size`, < 2^41.
    uint64_t weight_to(uint64_t size) const {
      const Bucket b = bucket_of(size);
      const uint64_t beyond = size ^ b.start;
      const uint64_t part = beyond * weights[b.index] >> b.width_log2;
      return blocks[b.index / kBlock] + before[b.index] + part;
    }
  };
  struct Bucket {
    uint32_t index;
    uint32_t width_log2;
    uint64_t start;  // a multiple of the width
  };
  /// Bucket of an error without its sign.
  static Bucket bucket_of(uint64_t error) {
    // Written so that it is what processors have.
    const uint32_t highest_bit = 63 ^ static_cast<uint32_t>(std::countl_zero(error | 64));
    const uint32_t width_log2 = highest_bit - 2;
    const uint64_t widths = error >> width_log2;
    return {4 * highest_bit + static_cast<uint32_t>(widths) - 24, width_log2, widths << width_log2};
  }
  void halve();

  Side sides_[2];  // errors >= 0, errors < 0
  uint32_t seen_;
  uint64_t scale_ = 0;
};

class ErrorModel::Reader {
 public:
  /// Weight of the errors from 0 to `error`, negative where `error` is; at most 2^40.
  int64_t weight_to(int64_t error) const {
    const int64_t sign = error >> 63;  // -1 or 0: no branch, which nobody could foresee
    const auto size = static_cast<uint64_t>((error ^ sign) - sign);
    const auto weight = static_cast<int64_t>(sides_[sign & 1]->weight_to(size) * scale_);
    return (weight ^ sign) - sign;
  }

 private:
  friend class ErrorModel;
  explicit Reader(const ErrorModel& m) : sides_{&m.sides_[0], &m.sides_[1]}, scale_(m.scale_) {}

  const Side* sides_[2];
  uint64_t scale_;
};

inline ErrorModel::Reader ErrorModel::reader() const { return Reader(*this); }

/// Adds up guesses of the kinds 0 .. kinds-1; see ErrorModel::observe for `memory`.
class GuessMixture {
 public:
  static constexpr size_t kMaxGuesses = 256;

  GuessMixture(uint32_t kinds, uint32_t memory) : memory_(memory), models_(kinds) {}

  void clear() { guesses_.clear(); }

  /// Beyond kMaxGuesses, guesses are ignored. `place` in 1/256; one step of the error model is 1/8
  /// of `scale`, which is in 1/256 too, 1 .. 2^24.
  void add(uint32_t kind, int64_t place, uint32_t scale) {
    if (guesses_.size() == kMaxGuesses) return;
    ErrorModel& model = models_[kind];
    guesses_.push_back({model.reader(), place, int64_t{(1u << 23) / scale}, &model});
  }

  /// Codes `value` in 0 .. count-1 and learns it. The guesses see value v as the interval [v, v+1).
  /// A decoder looks at `likely` (< count) first, then at distances reach, 2 reach, ... (reach > 0)
  /// beyond until the value is passed, then halves the range.
  template <class Coder>
  uint32_t code(Coder& coder, uint32_t value, uint32_t count, uint32_t likely, uint64_t reach) {
    make_room();
    Range r = {0, count, weigh(0, low_), weigh(count, high_)};
    const int64_t start = r.low;
    const auto whole = static_cast<uint64_t>(r.high - start);
    if constexpr (requires { coder.find(whole); }) {
      find(start + static_cast<int64_t>(coder.find(whole)), likely, reach, r);
    } else {
      r = {value, value + 1, weigh(value, low_), weigh(value + 1, high_)};
    }
    const auto size = static_cast<uint64_t>(r.high - r.low);
    coder.code({static_cast<uint64_t>(r.low - start), size, whole});
    observe(r.first, size);
    return r.first;
  }

 private:
  struct Range {
    uint32_t first, last;  // the value is in [first, last)
    int64_t low, high;     // weight below each
  };

  void make_room();
  /// Narrows a range down to the value whose interval has `place`.
  void find(int64_t place, uint32_t likely, uint64_t reach, Range& r);

  bool narrow(int64_t place, uint32_t split, Range& r) {
    const int64_t weight = weigh(split, split_);
    const bool up = place >= weight;
    (up ? r.first : r.last) = split;
    (up ? r.low : r.high) = weight;
    std::swap(up ? low_ : high_, split_);
    return up;
  }

  struct Guess {
    ErrorModel::Reader reader;
    int64_t place;
    int64_t gain;  // steps of the error model per unit of distance
    ErrorModel* model;
    /// Of `value` plus `part` / 256.
    int64_t error(uint32_t value, int64_t part = 0) const {
      return ((static_cast<int64_t>(value) << 8) + part - place) * gain >> 16;
    }
  };

  /// Weight of all values below `value`, up to a constant, by guess and in all; rises by at least
  /// kFloor per value.
  int64_t weigh(uint32_t value, int64_t* by_guess) const {
    int64_t sum = kFloor * value;
    for (const Guess& guess : guesses_) {
      const int64_t weight = guess.reader.weight_to(guess.error(value));
      *by_guess++ = weight;
      sum += weight;
    }
    return sum;
  }
  /// Learns `value`; low_ and high_ are the weights below it and below the next.
  void observe(uint32_t value, uint64_t all);

  static constexpr int64_t kFloor = 1 << 8;
  uint32_t memory_;
  std::vector<Guess> guesses_;
  std::vector<ErrorModel> models_;
  std::vector<int64_t> weights_;              // room for the next three
  int64_t *low_ = nullptr, *high_ = nullptr;  // weights by guess below the bounds of the range
  int64_t* split_ = nullptr;                  // the same below the split
};

}  // namespace reeb
