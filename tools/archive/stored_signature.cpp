#include "tools/archive/stored_signature.h"

#include <charconv>
#include <sstream>

namespace reeb::tools {
namespace {

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

}  // namespace

std::string signature_text(const retrieval::Signature& signature) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const uint8_t b : to_bytes(signature)) {
    text += kDigits[b >> 4];
    text += kDigits[b & 15];
  }
  return text;
}

bool parse_signature(const std::string& text, retrieval::Signature& out) {
  if (text.size() % 2 != 0) return false;
  std::vector<uint8_t> bytes;
  for (size_t i = 0; i < text.size(); i += 2) {
    const int high = digit(text[i]), low = digit(text[i + 1]);
    if (high < 0 || low < 0) return false;
    bytes.push_back(static_cast<uint8_t>(16 * high + low));
  }
  return retrieval::from_bytes(bytes, out) && !out.empty();
}

std::string stored_signatures(const std::vector<SignedFrame>& frames) {
  std::string text;
  for (const SignedFrame& f : frames) {
    if (!text.empty()) text += ' ';
    text += std::to_string(f.frame) + ":" + signature_text(f.signature);
  }
  return text;
}

bool parse_stored(const std::string& text, std::vector<SignedFrame>& out) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    SignedFrame& frame = out.emplace_back();
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), frame.frame);
    if (error != std::errc() || rest == word.data() + word.size() || *rest != ':') return false;
    if (frame.frame == 0 || !parse_signature(rest + 1, frame.signature)) return false;
  }
  return !out.empty();
}

}  // namespace reeb::tools
