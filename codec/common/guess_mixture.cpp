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

// A value may be wider than many buckets; then its share is spread over four places in it.
void ErrorModel::observe(int64_t from, int64_t to, uint32_t share, uint32_t memory) {
  constexpr int kPlaces = 4;
  const auto bucket = [](int64_t error) {
    return bucket_of(static_cast<uint64_t>(error < 0 ? -error - 1 : error)).index;
  };
  const bool together = (from < 0) == (to - 1 < 0) && bucket(from) == bucket(to - 1);
  for (int i = 0; i < (together ? 1 : kPlaces); ++i) {
    const int64_t error = together ? from : from + (to - from) * (2 * i + 1) / (2 * kPlaces);
    sides_[error < 0].add(bucket(error), together ? share : share / kPlaces);
  }
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
  auto p = static_cast<uint64_t>(part);
  auto w = static_cast<uint64_t>(whole);
  const int excess = std::max(static_cast<int>(std::bit_width(w)) - 47, 0);
  return static_cast<Probability>(
      std::clamp<uint64_t>(((p >> excess) << 16) / (w >> excess), 1, 65535));
}

int64_t GuessMixture::weight_below(uint32_t value) const {
  int64_t sum = kFloor * value;
  for (const Guess& g : guesses_) sum += models_[g.kind].weight_to(g.error(value));
  return sum;
}

void GuessMixture::observe(uint32_t value, uint64_t all) {
  // Shares first: guesses of one kind must not see what their fellows learn.
  shares_.clear();
  for (const Guess& g : guesses_) {
    const ErrorModel& model = models_[g.kind];
    const auto own = static_cast<uint64_t>(model.weight_to(g.error(value + 1)) -
                                           model.weight_to(g.error(value)));
    shares_.push_back(static_cast<uint32_t>(own * ErrorModel::kUnit / all));
  }
  for (size_t i = 0; i < guesses_.size(); ++i) {
    const Guess& g = guesses_[i];
    models_[g.kind].observe(g.error(value), g.error(value + 1), shares_[i], memory_);
  }
}

}  // namespace reeb
