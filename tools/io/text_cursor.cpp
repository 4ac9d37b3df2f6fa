#include "tools/io/text_cursor.h"

#include <cctype>

namespace reeb::tools {
namespace {

/// As much of `word` as fits into a message.
std::string quoted(std::string_view word) {
  std::string out;
  for (const char c : word.substr(0, 40))
    out += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
  return "'" + out + (word.size() > 40 ? "...'" : "'");
}

/// What may help where `word` makes no sense.
const char* remedy(std::string_view word) {
  if (word.find(',') != word.npos) return "; numbers need a decimal point, export the file again";
  if (word.find(".#") != word.npos)
    return ", for it is not finite; repair the frame or leave it out";
  return "; the file is damaged or another format, export it again";
}

}  // namespace

// CR CR LF is one end, too: what comes of ends that were translated twice.
void TextCursor::skip_line_end() {
  const char* p = at_;
  while (p != end_ && *p == '\r') ++p;
  if (p != end_ && *p == '\n') {
    ++p;
    const bool paired = p != end_ && *p == '\r' && (p + 1 == end_ || !is_line_end(p[1]));
    at_ = paired && *at_ == '\n' ? p + 1 : p;
  } else if (p != at_) {
    ++at_;
  }
}

bool TextCursor::skip_continuation() {
  const char* const start = at_;
  ++at_;
  skip_blanks();
  if (at_line_end()) {
    skip_line_end();
    return true;
  }
  at_ = start;
  return false;
}

void TextCursor::skip_continued_line() {
  while (true) {
    const char* const first = at_;
    skip_to_line_end();
    const char* last = at_;
    while (last != first && is_blank(last[-1])) --last;
    if (done() || last == first || last[-1] != '\\') return;
    skip_line_end();
  }
}

Status TextCursor::error(const std::string& what) const {
  TextCursor line({begin_, static_cast<size_t>(end_ - begin_)});
  size_t number = 0;
  do {
    line.next_line();
    ++number;
  } while (line.at_ <= at_ && !line.done());
  return Status::corrupt("line " + std::to_string(number) + ": " + what);
}

Status TextCursor::unexpected(const std::string& wanted) const {
  TextCursor here = *this;
  here.skip_blanks();
  const std::string_view word = here.word();
  const std::string found = word.empty() ? "the line ends where there should be " + wanted
                                         : quoted(word) + " is not " + wanted;
  return error(found + remedy(word));
}

Status skip_mark(std::string_view bytes, std::string_view& out) {
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
    return Status::corrupt("text in UTF-16; save it as ASCII or UTF-8");
  }
  out = bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
  return {};
}

Status open_text(std::string_view bytes, std::string_view& text) {
  if (Status status = skip_mark(bytes, text); !status.ok()) return status;
  if (text.ends_with('\x1a')) text.remove_suffix(1);
  return {};
}

}  // namespace reeb::tools
