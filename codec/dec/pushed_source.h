// The bytes of a file that arrives piece by piece.
#pragma once

#include <memory_resource>
#include <vector>

#include "bitstream/byte_source.h"

namespace reeb {

/// Keeps all bytes, in blocks, so that none of them ever moves.
class PushedSource : public ByteSource {
 public:
  static constexpr size_t kBlock = size_t{1} << 17;  ///< bytes

  explicit PushedSource(std::pmr::memory_resource* memory) : memory_(memory), blocks_(memory) {}
  ~PushedSource() override;
  PushedSource(const PushedSource&) = delete;
  PushedSource& operator=(const PushedSource&) = delete;

  uint64_t size() const override { return size_; }
  Status read(uint64_t offset, size_t count, std::vector<uint8_t>& buffer,
              std::span<const uint8_t>& out) override;
  /// Bytes of memory that `count` more will take.
  uint64_t memory_for(uint64_t count) const;
  /// Throws std::bad_alloc; nothing is added then.
  void append(std::span<const uint8_t> bytes);

 private:
  std::pmr::memory_resource* memory_;
  std::pmr::vector<uint8_t*> blocks_;
  uint64_t size_ = 0;
};

}  // namespace reeb
