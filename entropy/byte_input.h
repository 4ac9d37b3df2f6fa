// The bytes of a code as its decoder takes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace reeb {

class ByteInput {
 public:
  explicit ByteInput(std::span<const uint8_t> bytes) : bytes_(bytes) {}

  /// The next byte; zeros past the end.
  uint8_t next() {
    const size_t at = taken_++;
    return at < bytes_.size() ? bytes_[at] : uint8_t{0};
  }
  /// How many were taken, those past the end as well.
  size_t taken() const { return taken_; }
  size_t size() const { return bytes_.size(); }

 private:
  std::span<const uint8_t> bytes_;
  size_t taken_ = 0;
};

}  // namespace reeb
