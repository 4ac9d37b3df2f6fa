// Where the bytes of a file come from: memory, or a function that reads them when they are needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/status.h"

namespace reeb {

/// Bytes of one file. No two calls run at the same time on behalf of one reader.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Bytes there are; may grow between calls, never shrink.
  virtual uint64_t size() const = 0;
  /// `count` bytes from `offset` on, offset + count <= size(). `out` points into the source, or
  /// into `buffer`, which may be overwritten.
  virtual Status read(uint64_t offset, size_t count, std::vector<uint8_t>& buffer,
                      std::span<const uint8_t>& out) = 0;
};

/// Bytes in memory that outlive the source; nothing is copied.
class MemorySource : public ByteSource {
 public:
  explicit MemorySource(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  uint64_t size() const override { return bytes_.size(); }
  Status read(uint64_t offset, size_t count, std::vector<uint8_t>&,
              std::span<const uint8_t>& out) override {
    out = bytes_.subspan(static_cast<size_t>(offset), count);
    return {};
  }

 private:
  std::span<const uint8_t> bytes_;
};

}  // namespace reeb
