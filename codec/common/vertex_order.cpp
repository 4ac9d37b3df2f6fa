#include "codec/common/vertex_order.h"

#include <bit>

namespace reeb {

FreeIndices::FreeIndices(uint32_t count) : tree_(size_t{count} + 1), count_(count) {
  for (uint32_t i = 1; i < tree_.size(); ++i) tree_[i] = i & (0 - i);
}

uint32_t FreeIndices::rank(uint32_t index) const {
  uint32_t sum = 0;
  for (uint32_t i = index; i > 0; i &= i - 1) sum += tree_[i];
  return sum;
}

uint32_t FreeIndices::select(uint32_t rank) const {
  uint32_t at = 0;
  for (auto step = static_cast<uint32_t>(std::bit_floor(tree_.size() - 1)); step > 0; step /= 2) {
    if (at + step < tree_.size() && tree_[at + step] <= rank) {
      at += step;
      rank -= tree_[at];
    }
  }
  return at;
}

void FreeIndices::take(uint32_t index) {
  for (uint64_t i = uint64_t{index} + 1; i < tree_.size(); i += i & (0 - i)) --tree_[i];
  --count_;
}

}  // namespace reeb
