#include "codec/dec/pushed_source.h"

#include <algorithm>

namespace reeb {

PushedSource::~PushedSource() {
  for (uint8_t* block : blocks_) memory_->deallocate(block, kBlock, 1);
}

uint64_t PushedSource::memory_for(uint64_t count) const {
  const uint64_t blocks = (size_ + count + kBlock - 1) / kBlock;
  return (blocks - blocks_.size()) * kBlock;
}

void PushedSource::append(std::span<const uint8_t> bytes) {
  const uint64_t end = size_ + bytes.size();
  while (blocks_.size() * kBlock < end) {
    // First, so that adding the block cannot fail.
    if (blocks_.size() == blocks_.capacity()) blocks_.reserve(2 * blocks_.size() + 8);
    blocks_.push_back(static_cast<uint8_t*>(memory_->allocate(kBlock, 1)));
  }
  while (!bytes.empty()) {
    const size_t at = static_cast<size_t>(size_ % kBlock);
    const size_t count = std::min(bytes.size(), kBlock - at);
    std::copy_n(bytes.begin(), count, blocks_[static_cast<size_t>(size_ / kBlock)] + at);
    bytes = bytes.subspan(count);
    size_ += count;
  }
}

Status PushedSource::read(uint64_t offset, size_t count, std::vector<uint8_t>& buffer,
                          std::span<const uint8_t>& out) {
  buffer.clear();
  buffer.reserve(count);
  while (buffer.size() < count) {
    const uint64_t from = offset + buffer.size();
    const size_t at = static_cast<size_t>(from % kBlock);
    const size_t part = std::min(count - buffer.size(), kBlock - at);
    const uint8_t* bytes = blocks_[static_cast<size_t>(from / kBlock)] + at;
    buffer.insert(buffer.end(), bytes, bytes + part);
  }
  out = buffer;
  return {};
}

}  // namespace reeb
