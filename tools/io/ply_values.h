// The values of a PLY file one after another, in text or in binary.
//
// Both readers have the same members. After a failure every further read gives zero.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/io/ply_header.h"
#include "tools/io/text_cursor.h"
#include "tools/text.h"

namespace reeb::tools {

/// A line for each row.
class PlyTextValues {
 public:
  /// The first `header_bytes` of `file` are passed over.
  PlyTextValues(std::string_view file, size_t header_bytes) : in_(file) {
    in_.advance(header_bytes);
  }
  bool failed() const { return failed_; }
  size_t remaining() const { return in_.remaining(); }

  void begin_row() { in_.skip_space(); }
  void end_row() {
    in_.skip_blanks();
    failed_ = failed_ || !in_.at_line_end();
  }
  Real real(PlyType) { return number<Real>(); }
  int64_t integer(PlyType) { return number<int64_t>(); }
  void skip(PlyType, uint64_t count) {
    for (uint64_t i = 0; i < count && !failed_; ++i) {
      in_.skip_blanks();
      failed_ = in_.word().empty();
    }
  }

  /// Where the values stopped to make sense.
  Status failure() const { return in_.unexpected("what the header announces"); }
  /// Behind the last row: there may be no more.
  Status finish(std::vector<std::string>&) {
    in_.skip_space();
    return in_.done() ? Status() : failure();
  }

 private:
  template <typename T>
  T number() {
    T value{};
    in_.skip_blanks();
    failed_ = failed_ || !in_.read(value);
    return value;
  }

  TextCursor in_;
  bool failed_ = false;
};

class PlyBinaryValues {
 public:
  PlyBinaryValues(std::string_view file, size_t header_bytes, bool big_endian)
      : in_(file.substr(header_bytes)), big_endian_(big_endian) {}
  bool failed() const { return failed_; }
  size_t remaining() const { return in_.size(); }

  void begin_row() {}
  void end_row() {}
  Real real(PlyType type) {
    if (type == PlyType::kFloat) return {std::bit_cast<float>(static_cast<uint32_t>(raw(4)))};
    const double exact = type == PlyType::kDouble ? std::bit_cast<double>(raw(8))
                                                  : static_cast<double>(integer(type));
    const auto value = static_cast<float>(exact);
    return {value, std::isfinite(value) ? static_cast<float>(exact - double{value}) : 0.0f};
  }
  /// -1 where the number is not whole or is beyond 2^32.
  int64_t integer(PlyType type) {
    const uint64_t bits = raw(ply_size(type));
    switch (type) {
      case PlyType::kInt8:
        return static_cast<int8_t>(bits);
      case PlyType::kInt16:
        return static_cast<int16_t>(bits);
      case PlyType::kInt32:
        return static_cast<int32_t>(bits);
      case PlyType::kFloat:
        return whole(std::bit_cast<float>(static_cast<uint32_t>(bits)));
      case PlyType::kDouble:
        return whole(std::bit_cast<double>(bits));
      default:
        return static_cast<int64_t>(bits);
    }
  }
  void skip(PlyType type, uint64_t count) {
    failed_ = failed_ || count > in_.size() / ply_size(type);
    if (!failed_) in_.remove_prefix(count * ply_size(type));
  }

  Status failure() const {
    return Status::corrupt("the file is truncated or damaged, export it again");
  }
  Status finish(std::vector<std::string>& notes) const {
    if (!in_.empty())
      notes.push_back(counted(in_.size(), "byte") + " behind the last element ignored");
    return {};
  }

 private:
  static int64_t whole(double value) {
    const bool good = std::abs(value) < 0x1p32 && std::trunc(value) == value;
    return good ? static_cast<int64_t>(value) : -1;
  }

  uint64_t raw(size_t size) {
    if (failed_ || in_.size() < size) {
      failed_ = true;
      return 0;
    }
    uint64_t bits = 0;
    for (size_t i = 0; i < size; ++i) {
      const size_t byte = big_endian_ ? size - 1 - i : i;
      bits |= uint64_t{static_cast<uint8_t>(in_[byte])} << (8 * i);
    }
    in_.remove_prefix(size);
    return bits;
  }

  std::string_view in_;
  bool big_endian_;
  bool failed_ = false;
};

}  // namespace reeb::tools
