#include "codec/common/guess_mixture.h"

#include <algorithm>
#include <bit>

namespace reeb {
namespace {

constexpr uint32_t kInnerBuckets = 8;  // of one step each

struct Bucket {
  uint32_t index;
  uint64_t start;
  uint32_t width_log2;
};

// Bucket of an error without its sign, < 2^41.
Bucket bucket_of(uint64_t error) {
  if (error < 16 * kInnerBuckets)
    return {static_cast<uint32_t>(error >> 4), error & ~uint64_t{15}, 4};
  const uint32_t width_log2 = static_cast<uint32_t>(std::bit_width(error)) - 3;
  const uint64_t quarter = error >> width_log2;  // 4 .. 7
  return {kInnerBuckets + (width_log2 - 5) * 4 + static_cast<uint32_t>(quarter - 4),
          quarter << width_log2, width_log2};
}

}  // namespace

// Near errors are likelier at first, by 1/16 from bucket to bucket.
ErrorModel::ErrorModel() : seen_(4 * kUnit) {
  uint32_t weight = kUnit / 16;
  for (uint32_t b = 0; b < sides_[0].weight.size(); ++b) {
    if (b >= kInnerBuckets) weight = std::max(weight - weight / 16, 1u);
    sides_[0].weight[b] = weight;
  }
  sides_[0].sum_up();
  sides_[1] = sides_[0];
  scale_ = (uint64_t{1} << 32) / seen_;
}

void ErrorModel::Side::add(uint32_t bucket, uint32_t share) {
  weight[bucket] += share;
  const uint32_t block = bucket / kBlock;
  for (uint32_t b = bucket + 1; b < (block + 1) * kBlock; ++b) inner[b] += share;
  for (uint32_t k = block + 1; k < kBlocks; ++k) blocks[k] += share;
}

void ErrorModel::Side::sum_up() {
  uint32_t all = 0;
  for (uint32_t k = 0; k < kBlocks; ++k) {
    blocks[k] = all;
    uint32_t sum = 0;
    for (uint32_t b = k * kBlock; b < (k + 1) * kBlock; ++b) {
      inner[b] = sum;
      sum += weight[b];
    }
    all += sum;
  }
}

int64_t ErrorModel::weight_to(int64_t error) const {
  const bool negative = error < 0;
  const auto size = static_cast<uint64_t>(negative ? -error : error);
  const Bucket b = bucket_of(size);
  const Side& side = sides_[negative];
  const uint64_t part = ((size - b.start) * (uint64_t{side.weight[b.index]} << 8)) >> b.width_log2;
  const uint64_t inner = side.blocks[b.index / kBlock] + side.inner[b.index];
  const auto weight = static_cast<int64_t>(((inner << 8) + part) * scale_);
  return negative ? -weight : weight;
}

void ErrorModel::observe(int64_t error, uint32_t share, uint32_t memory) {
  const auto size = static_cast<uint64_t>(error < 0 ? -error - 1 : error);
  if (share > 0) sides_[error < 0].add(bucket_of(size).index, share);
  seen_ += kUnit;
  if (seen_ > memory * kUnit) halve();
  scale_ = (uint64_t{1} << 32) / seen_;
}

void ErrorModel::halve() {
  seen_ /= 2;
  for (Side& side : sides_) {
    for (uint32_t& w : side.weight) w -= w / 2;
    side.sum_up();
  }
}

Probability GuessMixture::probability(int64_t part, int64_t whole) {
  const auto w = static_cast<uint64_t>(whole);
  const int excess = std::max(static_cast<int>(std::bit_width(w)) - 47, 0);
  const uint64_t divisor = std::max(w >> excess, uint64_t{1});
  const uint64_t ratio = (static_cast<uint64_t>(part) >> excess << 16) / divisor;
  return static_cast<Probability>(std::clamp<uint64_t>(ratio, 1, 65535));
}

int64_t GuessMixture::weigh(uint32_t value, std::vector<int64_t>& by_guess) const {
  by_guess.resize(guesses_.size());
  int64_t sum = kFloor * value;
  for (size_t i = 0; i < guesses_.size(); ++i) {
    by_guess[i] = models_[guesses_[i].kind].weight_to(guesses_[i].error(value));
    sum += by_guess[i];
  }
  return sum;
}

void GuessMixture::observe(uint32_t value, uint64_t all) {
  for (size_t i = 0; i < guesses_.size(); ++i) {
    const Guess& g = guesses_[i];
    const auto own = static_cast<uint64_t>(high_[i] - low_[i]);
    const auto share = static_cast<uint32_t>(own * ErrorModel::kUnit / all);
    models_[g.kind].observe(g.error(value, 128), share, memory_);
  }
}

}  // namespace reeb
