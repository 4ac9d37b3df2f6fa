#include "codec/dec/connectivity/symbol_reader.h"

#include <algorithm>
#include <span>

namespace reeb {
namespace {

constexpr uint32_t kMinDegree = 2;  // of the first list
constexpr uint32_t kSymbols = 5;
enum class ListCode : uint8_t { kByLength = 0, kDirect = 1 };

// Symbols as their number of bits, 0 to 3, and the bits themselves behind all of them.
bool read_lengths(ByteReader& in, std::span<uint8_t> out) {
  AnsSymbols lengths;
  if (!lengths.open(in, 4)) return false;
  uint64_t bit_count = 0;
  for (uint8_t& length : out) bit_count += length = lengths.next();
  RawBitReader bits(in.take((bit_count + 7) / 8));
  for (uint8_t& symbol : out) symbol = static_cast<uint8_t>(bits.code(0, symbol));
  return in.ok() && bits.at_end() && lengths.at_end();
}

// The largest number of bits only chooses how fine probabilities are, which from 1 to 8 bits is the
// same.
bool read_symbols(ByteReader& in, std::span<uint8_t> out) {
  const uint8_t bits = in.u8();
  AnsSymbols symbols;
  if (bits < 1 || bits > 8 || !symbols.open(in, kSymbols)) return false;
  for (uint8_t& symbol : out) symbol = symbols.next();
  return symbols.at_end();
}

bool read_list(ByteReader& in, std::span<uint8_t> out) {
  if (out.empty()) return true;
  switch (ListCode{in.u8()}) {
    case ListCode::kByLength:
      return read_lengths(in, out);
    case ListCode::kDirect:
      return read_symbols(in, out);
  }
  return false;
}

}  // namespace

bool SymbolReader::open(ByteReader& in, Traversal traversal, uint32_t count) {
  traversal_ = traversal;
  if (traversal == Traversal::kStandard) return open_bits(in) && starts_.open(in);
  return starts_.open(in) && open_lists(in, count);
}

bool SymbolReader::open_bits(ByteReader& in) {
  bits_ = RawBitReader(in.take(in.varuint()));
  return in.ok();
}

// The first symbol is in no list: it can only be the end that decoding starts from.
bool SymbolReader::open_lists(ByteReader& in, uint32_t count) {
  symbols_.resize(count - 1);
  uint32_t at = 0;
  for (uint32_t i = 0; i < kLists; ++i) {
    const uint64_t size = in.varuint();
    if (!in.ok() || size > symbols_.size() - at) return false;
    begin_[i] = at;
    end_[i] = at += static_cast<uint32_t>(size);
    if (!read_list(in, std::span(symbols_).subspan(begin_[i], static_cast<size_t>(size))))
      return false;
  }
  return at == symbols_.size() &&
         std::all_of(symbols_.begin(), symbols_.end(), [](uint8_t s) { return s < kSymbols; });
}

Symbol SymbolReader::next_bits() {
  if (bits_.code(0, 1) == 0) return Symbol::kClose;
  return Symbol(1 + bits_.code(0, 2));
}

bool SymbolReader::next(uint32_t degree, Symbol& symbol) {
  if (traversal_ == Traversal::kStandard) {
    symbol = next_bits();
    return !bits_.overrun();
  }
  symbol = Symbol::kEnd;
  if (degree == 0) return true;
  const uint32_t list = std::clamp(degree, kMinDegree, kMinDegree + kLists - 1) - kMinDegree;
  if (end_[list] == begin_[list]) return false;
  symbol = Symbol(symbols_[--end_[list]]);
  return true;
}

bool SymbolReader::at_end() {
  if (traversal_ == Traversal::kStandard && !bits_.at_end()) return false;
  return begin_ == end_ && starts_.at_end();
}

}  // namespace reeb
