// A position in the text of a mesh file, with the small steps its readers take.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "bitstream/status.h"

namespace reeb::tools {

/// Numbers do not depend on the locale; a float is the one nearest to the decimal text.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text)
      : begin_(text.data()), at_(text.data()), end_(text.data() + text.size()) {}

  bool done() const { return at_ == end_; }
  size_t remaining() const { return static_cast<size_t>(end_ - at_); }
  std::string_view rest() const { return {at_, remaining()}; }
  size_t offset() const { return static_cast<size_t>(at_ - begin_); }
  void advance(size_t n) { at_ += std::min(n, remaining()); }

  /// The character `ahead` of here; 0 past the end.
  char peek(size_t ahead = 0) const { return ahead < remaining() ? at_[ahead] : '\0'; }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  /// Blanks and ends of lines.
  void skip_space() {
    while (at_ != end_ && (is_blank(*at_) || *at_ == '\n')) ++at_;
  }
  /// Blanks and ends of lines behind a backslash.
  void skip_blanks_and_continuations() {
    for (skip_blanks(); peek() == '\\'; skip_blanks()) {
      const size_t line_end = peek(1) == '\r' ? 2 : 1;
      if (peek(line_end) != '\n') return;
      at_ += line_end + 1;
    }
  }
  bool at_line_end() const { return at_ == end_ || *at_ == '\n'; }
  /// To the first character of the next line.
  void next_line() {
    const void* const found = std::memchr(at_, '\n', remaining());
    at_ = found == nullptr ? end_ : static_cast<const char*>(found) + 1;
  }
  /// The characters up to the next blank or end of line.
  std::string_view word() {
    const char* const first = at_;
    while (!at_line_end() && !is_blank(*at_)) ++at_;
    return {first, static_cast<size_t>(at_ - first)};
  }

  /// Reads a number here and steps behind it; false, without a step, where there is none.
  bool read(float& value);
  bool read(int64_t& value);
  bool read(uint64_t& value);

  /// "line N: WHAT", N the line of this position.
  Status error(const std::string& what) const {
    const auto line = std::count(begin_, at_, '\n') + 1;
    return Status::corrupt("line " + std::to_string(line) + ": " + what);
  }

 private:
  void skip_plus() {
    if (peek() == '+' && peek(1) != '-') ++at_;
  }
  template <typename Integer>
  bool read_integer(Integer& value) {
    const char* const start = at_;
    skip_plus();
    const auto [stop, error] = std::from_chars(at_, end_, value);
    at_ = error == std::errc() ? stop : start;
    return error == std::errc();
  }

  const char* begin_;
  const char* at_;
  const char* end_;
};

inline bool TextCursor::read(float& value) {
  const char* const start = at_;
  skip_plus();
  const auto [stop, error] = std::from_chars(at_, end_, value);
  if (error == std::errc::result_out_of_range) {
    // Too small for float32 is zero, too large is infinity, which the caller refuses.
    double wide = 0;
    if (std::from_chars(at_, end_, wide).ec != std::errc()) {
      const std::string_view number(at_, static_cast<size_t>(stop - at_));
      const size_t exponent = number.find_first_of("eE");
      const bool tiny = exponent != number.npos && number.substr(exponent + 1, 1) == "-";
      wide = tiny ? 0.0 : 1e300;
    }
    value = static_cast<float>(wide);
  } else if (error != std::errc()) {
    at_ = start;
    return false;
  }
  at_ = stop;
  return true;
}

inline bool TextCursor::read(int64_t& value) { return read_integer(value); }
inline bool TextCursor::read(uint64_t& value) { return read_integer(value); }

}  // namespace reeb::tools
