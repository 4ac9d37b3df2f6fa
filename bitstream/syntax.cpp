#include "bitstream/syntax.h"

#include <charconv>

#include "bitstream/utf8.h"

namespace reeb {
namespace {

std::string message(const std::string& header, const char* name, std::string_view what) {
  return header + ": " + name + " " + std::string(what);
}

// Shortest text that reads back as the same number, whatever the locale.
template <class T>
std::string number(T value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

std::string out_of_range(uint64_t value) { return "is out of range: " + number(value); }

// The tables for texts of real numbers are as large as half a decoder: those that cannot have them
// leave the number out.
#ifdef REEB_WITHOUT_REAL_TEXT
std::string real_text(double, bool) { return "?"; }
std::string out_of_range(double) { return "is out of range"; }
#else
std::string real_text(double value, bool wide) {
  return wide ? number(value) : number(static_cast<float>(value));
}
std::string out_of_range(double value) { return "is out of range: " + number(value); }
#endif

// Text inside quotes, bytes that would break a line or a terminal as \xNN.
std::string quoted(std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto b = static_cast<uint8_t>(c);
    if (b < 0x20 || b == 0x7F || c == '"' || c == '\\') {
      out += {'\\', 'x', kHex[b >> 4], kHex[b & 15]};
    } else {
      out += c;
    }
  }
  return out + "\"";
}

}  // namespace

void SyntaxReader::trace_to(std::string* lines, size_t base_offset) {
  lines_ = lines;
  base_offset_ = base_offset;
}

void SyntaxReader::trace_line(size_t offset, const char* name, const std::string& value) {
  if (lines_ == nullptr || !status_.ok()) return;
  *lines_ += number(base_offset_ + offset) + "   " + name + " " + value + "\n";
}

void SyntaxReader::fail(const char* name, std::string_view what) {
  if (status_.ok()) status_ = Status::corrupt(message(header_, name, what));
}

bool SyntaxReader::check_bytes(const char* name) {
  if (!in_.ok()) fail(name, in_.ran_out() ? "is cut off" : "is malformed");
  return status_.ok();
}

void SyntaxReader::integer_field(const char* name, uint64_t& value, uint64_t lowest,
                                 uint64_t highest, bool one_byte) {
  const size_t offset = in_.position();
  value = one_byte ? in_.u8() : in_.varuint();
  const bool in_range = value >= lowest && value <= highest;
  if (check_bytes(name) && !in_range) fail(name, out_of_range(value));
  trace_line(offset, name, number(value));
  if (!status_.ok()) value = lowest;
}

void SyntaxReader::real(const char* name, double& value, double lowest, double highest, bool wide) {
  const size_t offset = in_.position();
  value = wide ? in_.f64() : double{in_.f32()};
  const bool in_range = value >= lowest && value <= highest;  // false for NaN
  if (check_bytes(name) && !in_range) fail(name, out_of_range(value));
  if (lines_ != nullptr) trace_line(offset, name, real_text(value, wide));
  if (!status_.ok()) value = lowest;
}

void SyntaxReader::text_field(const char* name, std::string& value) {
  const size_t offset = in_.position();
  const auto text = in_.take(in_.varuint());
  check_bytes(name);
  // By a pointer: iterators would have it copied once more.
  value.assign(reinterpret_cast<const char*>(text.data()), text.size());
  if (!is_utf8(value)) fail(name, "is not UTF-8");
  if (lines_ != nullptr) trace_line(offset, name, quoted(value));
}

size_t SyntaxReader::list_size(const char* name, size_t, size_t entry_bytes) {
  const size_t offset = in_.position();
  const uint64_t count = in_.varuint();
  if (check_bytes(name) && count > in_.remaining() / entry_bytes) {
    fail(name, "promises more entries than bytes: " + number(count));
  }
  trace_line(offset, name, number(count));
  return status_.ok() ? static_cast<size_t>(count) : 0;
}

void SyntaxWriter::fail(const char* name, std::string_view what) {
  if (status_.ok()) status_ = Status::invalid(message(header_, name, what));
}

void SyntaxWriter::integer_field(const char* name, uint64_t& value, uint64_t lowest,
                                 uint64_t highest, bool one_byte) {
  if (value < lowest || value > highest) fail(name, out_of_range(value));
  if (one_byte) {
    out_.push_back(static_cast<uint8_t>(value));
  } else {
    append_varuint(out_, value);
  }
}

void SyntaxWriter::real(const char* name, double& value, double lowest, double highest, bool wide) {
  if (!(value >= lowest && value <= highest)) fail(name, out_of_range(value));
  if (wide) {
    append_f64(out_, value);
  } else {
    append_f32(out_, static_cast<float>(value));
  }
}

void SyntaxWriter::text_field(const char* name, std::string& value) {
  if (!is_utf8(value)) fail(name, "is not UTF-8");
  append_varuint(out_, value.size());
  out_.insert(out_.end(), value.begin(), value.end());
}

size_t SyntaxWriter::list_size(const char*, size_t count, size_t) {
  append_varuint(out_, count);
  return count;
}

}  // namespace reeb
