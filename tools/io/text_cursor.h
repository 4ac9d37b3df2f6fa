// A position in the text of a mesh file, with the small steps its readers take.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "bitstream/status.h"
#include "tools/io/text_number.h"

namespace reeb::tools {

/// Lines end in LF, CR, CR LF or LF CR, also by turns. Numbers do not depend on the locale and end
/// where `ends_number` says so: "0,5" and "1.#IND" are none.
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
  bool at_line_end() const { return at_ == end_ || is_line_end(*at_); }
  bool at_number_end() const { return at_ == end_ || ends_number(*at_); }

  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  /// Blanks and ends of lines.
  void skip_space() {
    while (at_ != end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
  }
  /// Blanks, and ends of lines behind a backslash.
  void skip_blanks_and_continuations() {
    for (skip_blanks(); peek() == '\\' && skip_continuation();) skip_blanks();
  }
  void skip_to_line_end() {
    while (!at_line_end()) ++at_;
  }
  /// To the end of the line, or where it continues behind a backslash of the last of its lines.
  void skip_continued_line();
  /// A sign and digits, as many as there are.
  void skip_integer() {
    if (peek() == '-' || peek() == '+') ++at_;
    while (at_ != end_ && is_digit(*at_)) ++at_;
  }
  /// To the first character of the next line.
  void next_line() {
    skip_to_line_end();
    skip_line_end();
  }
  /// The characters up to the next blank or end of line.
  std::string_view word() {
    const char* const first = at_;
    while (!at_line_end() && !is_blank(*at_)) ++at_;
    return {first, static_cast<size_t>(at_ - first)};
  }

  /// Reads a number here and steps behind it; false, without a step, where there is none.
  bool read(Real& value) {
    const char* const stop = read_real(at_, end_, value);
    if (stop != nullptr) at_ = stop;
    return stop != nullptr;
  }
  template <typename Integer>
  bool read(Integer& value) {
    const char* const start = at_;
    if (read_prefix(value) && at_number_end()) return true;
    at_ = start;
    return false;
  }
  /// An integer that something else may follow.
  template <typename Integer>
  bool read_prefix(Integer& value) {
    const char* const first = at_ + (peek() == '+' && peek(1) != '-' ? 1 : 0);
    const auto [stop, error] = std::from_chars(first, end_, value);
    if (error == std::errc()) at_ = stop;
    return error == std::errc();
  }

  /// "line N: WHAT", N the line of this position.
  Status error(const std::string& what) const;
  /// That something else stands where `wanted` should: "line N: '0,5' is not WANTED; ...".
  Status unexpected(const std::string& wanted) const;

 private:
  void skip_line_end();
  bool skip_continuation();

  const char* begin_;
  const char* at_;
  const char* end_;
};

/// What follows a byte-order mark. UTF-16 is refused by name.
Status skip_mark(std::string_view bytes, std::string_view& out);
/// A text without its byte-order mark and the character that ended files of CP/M and DOS.
Status open_text(std::string_view bytes, std::string_view& text);

}  // namespace reeb::tools
