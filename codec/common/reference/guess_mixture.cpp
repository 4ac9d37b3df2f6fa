#include "codec/common/reference/guess_mixture.h"

#include <algorithm>
#include <bit>

namespace reeb {

// From entry kBlock - 1 - i on, all bits are set in those of the following kBlock whose number is
// above i.
constexpr std::array<uint32_t, 2 * ErrorModel::kBlock> ErrorModel::kAfter = [] {
  std::array<uint32_t, 2 * kBlock> masks{};
  std::fill(masks.begin() + kBlock, masks.end(), UINT32_MAX);
  return masks;
}();

// Near errors are likelier at first, by 1/16 from bucket to bucket.
ErrorModel::ErrorModel() : seen_(4 * kUnit), scale_((uint64_t{1} << 32) / seen_) {
  constexpr uint32_t kInnerBuckets = 8;  // of one step each
  uint32_t weight = kUnit / 16;
  for (uint32_t b = 0; b < kBuckets; ++b) {
    if (b >= kInnerBuckets) weight = std::max(weight - weight / 16, 1u);
    for (Side& side : sides_) side.weights[b] = weight << 8;
  }
  for (Side& side : sides_) side.sum_up();
}

void ErrorModel::Side::add(uint32_t bucket, uint32_t weight) {
  // Of fixed length, for vector units.
  const uint32_t block = bucket / kBlock;
  uint32_t* const inner = &before[block * kBlock];
  const uint32_t* const after = &kAfter[kBlock - 1 - bucket % kBlock];
  for (uint32_t i = 0; i < kBlock; ++i) inner[i] += after[i] & weight;
  const uint32_t* const blocks_after = &kAfter[kBlock - 1 - block];
  for (uint32_t k = 0; k < blocks.size(); ++k) blocks[k] += blocks_after[k] & weight;
  weights[bucket] += weight;
}

void ErrorModel::Side::sum_up() {
  uint32_t all = 0;
  for (uint32_t k = 0; k < kBlocks; ++k) {
    blocks[k] = all;
    uint32_t sum = 0;
    for (uint32_t b = k * kBlock; b < (k + 1) * kBlock; ++b) {
      before[b] = sum;
      sum += weights[b];
    }
    all += sum;
  }
}

void ErrorModel::observe(int64_t error, uint32_t share, uint32_t memory) {
  const auto size = static_cast<uint64_t>(error < 0 ? -error - 1 : error);
  if (share > 0) sides_[error < 0].add(bucket_of(size).index, share << 8);
  seen_ += kUnit;
  if (seen_ > memory * kUnit) halve();
  scale_ = (uint64_t{1} << 32) / seen_;
}

void ErrorModel::halve() {
  seen_ /= 2;
  for (Side& side : sides_) {
    for (uint32_t& w : side.weights) w -= w >> 9 << 8;
    side.sum_up();
  }
}

void GuessMixture::make_room() {
  const size_t size = guesses_.size();
  weights_.resize(std::max(weights_.size(), 3 * size));
  low_ = weights_.data();
  high_ = low_ + size;
  split_ = high_ + size;
}

void GuessMixture::find(int64_t place, uint32_t likely, uint64_t reach, Range& r) {
  const bool up = likely == 0 || narrow(place, likely, r);
  bool passed = false;
  for (uint64_t split = likely; !passed && reach < (up ? r.last - split : split - r.first);
       reach *= 2) {
    split = up ? split + reach : split - reach;
    passed = narrow(place, static_cast<uint32_t>(split), r) != up;
  }
  while (r.last - r.first > 1) narrow(place, r.first + (r.last - r.first) / 2, r);
}

void GuessMixture::observe(uint32_t value, uint64_t all) {
  for (size_t i = 0; i < guesses_.size(); ++i) {
    const Guess& g = guesses_[i];
    const auto own = static_cast<uint64_t>(high_[i] - low_[i]);
    const auto share = static_cast<uint32_t>(own * ErrorModel::kUnit / all);
    g.model->observe(g.error(value, 128), share, memory_);
  }
}

}  // namespace reeb
