#include "codec/common/guess_mixture.h"

#include <algorithm>
#include <bit>

namespace reeb {

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

void GuessMixture::observe(uint32_t value, uint64_t all) {
  for (size_t i = 0; i < guesses_.size(); ++i) {
    const Guess& g = guesses_[i];
    const auto own = static_cast<uint64_t>(high_[i] - low_[i]);
    const auto share = static_cast<uint32_t>(own * ErrorModel::kUnit / all);
    models_[g.kind].observe(g.error(value, 128), share, memory_);
  }
}

}  // namespace reeb
