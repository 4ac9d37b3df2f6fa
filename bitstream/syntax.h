// Visitors over header descriptions. A header is described once, in `headers.h`, as
//   template <class V> void describe(V& v, Header& h) { v.uv("field", h.field, lowest, highest);
//   ... }
// and read, written and traced by handing it one of the visitors below.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bitstream/bytes.h"
#include "bitstream/status.h"

namespace reeb {

/// The field calls of a description, in terms of four primitives of the visitor `Self`:
/// integer, real, text and list_size. Ranges are inclusive.
template <class Self>
class SyntaxVisitor {
 public:
  /// One byte.
  template <class T>
  void u8(const char* name, T& value, uint64_t lowest, uint64_t highest) {
    integer(name, value, lowest, highest, true);
  }
  /// Variable-length unsigned integer.
  template <class T>
  void uv(const char* name, T& value, uint64_t lowest, uint64_t highest) {
    integer(name, value, lowest, highest, false);
  }
  /// One byte of flags; bits outside `known` are reserved and 0.
  void flags(const char* name, uint8_t& value, uint8_t known) {
    u8(name, value, 0, 255);
    if ((value & ~known) != 0) self().fail(name, "has reserved bits set");
  }
  void f32(const char* name, float& value, double lowest, double highest) {
    double wide = value;
    self().real(name, wide, lowest, highest, false);
    value = static_cast<float>(wide);
  }
  void f64(const char* name, double& value, double lowest, double highest) {
    self().real(name, value, lowest, highest, true);
  }
  /// Length (uv), then that many bytes of UTF-8.
  void text(const char* name, std::string& value) { self().text_field(name, value); }
  /// Count (uv), then the entries, each described by itself and at least `entry_bytes` long.
  template <class T>
  void list(const char* name, std::vector<T>& entries, size_t entry_bytes) {
    entries.resize(self().list_size(name, entries.size(), entry_bytes));
    for (T& entry : entries) describe(self(), entry);
  }

 private:
  Self& self() { return static_cast<Self&>(*this); }
  template <class T>
  void integer(const char* name, T& value, uint64_t lowest, uint64_t highest, bool one_byte) {
    uint64_t wide = static_cast<uint64_t>(value);
    self().integer_field(name, wide, lowest, highest, one_byte);
    value = static_cast<T>(wide);
  }
};

/// Fills a header from bytes. The first fault sticks; fields after it read as their lowest value.
class SyntaxReader : public SyntaxVisitor<SyntaxReader> {
 public:
  /// `header` names the header in messages.
  SyntaxReader(ByteReader& in, std::string header) : in_(in), header_(std::move(header)) {}
  void integer_field(const char* name, uint64_t& value, uint64_t lowest, uint64_t highest,
                     bool one_byte);
  void real(const char* name, double& value, double lowest, double highest, bool wide);
  void text_field(const char* name, std::string& value);
  size_t list_size(const char* name, size_t count, size_t entry_bytes);
  void fail(const char* name, std::string_view what);
  const Status& status() const { return status_; }
  /// When set, every field read is appended here as a line "offset name value".
  void trace_to(std::string* lines, size_t base_offset);

 private:
  bool check_bytes(const char* name);
  void trace_line(size_t offset, const char* name, const std::string& value);

  ByteReader& in_;
  std::string header_;
  Status status_;
  std::string* lines_ = nullptr;
  size_t base_offset_ = 0;
};

/// Appends a header to bytes and checks the ranges of what it is given.
class SyntaxWriter : public SyntaxVisitor<SyntaxWriter> {
 public:
  SyntaxWriter(std::vector<uint8_t>& out, std::string header)
      : out_(out), header_(std::move(header)) {}
  void integer_field(const char* name, uint64_t& value, uint64_t lowest, uint64_t highest,
                     bool one_byte);
  void real(const char* name, double& value, double lowest, double highest, bool wide);
  void text_field(const char* name, std::string& value);
  size_t list_size(const char* name, size_t count, size_t entry_bytes);
  void fail(const char* name, std::string_view what);
  const Status& status() const { return status_; }

 private:
  std::vector<uint8_t>& out_;
  std::string header_;
  Status status_;
};

/// Reads header `h` from `in`.
template <class Header>
Status read_header(ByteReader& in, std::string name, Header& h) {
  SyntaxReader reader(in, std::move(name));
  describe(reader, h);
  return reader.status();
}

/// Appends header `h` to `out`; an out-of-range field is an invalid argument.
template <class Header>
Status write_header(const Header& h, std::string name, std::vector<uint8_t>& out) {
  SyntaxWriter writer(out, std::move(name));
  Header copy = h;
  describe(writer, copy);
  return writer.status();
}

}  // namespace reeb
