#include "codec/dec/connectivity/ans.h"

namespace reeb {
namespace {

constexpr uint32_t kBitBase = 1u << 12, kSymbolBase = 1u << 14;
constexpr uint32_t kBitBytes = 3, kSymbolBytes = 4;  // of the first state, at most
constexpr uint32_t kSymbolBits = 12;                 // of a probability

}  // namespace

bool AnsState::open(std::span<const uint8_t> bytes, uint32_t base, uint32_t most_bytes) {
  if (bytes.empty()) return false;
  const uint32_t count = (bytes.back() >> 6) + 1u;
  if (count > most_bytes || count > bytes.size()) return false;
  uint32_t value = bytes.back() & 0x3Fu;
  for (uint32_t i = 2; i <= count; ++i) value = value << 8 | bytes[bytes.size() - i];
  bytes_ = bytes.first(bytes.size() - count);
  base_ = base;
  value_ = base + value;
  overrun_ = false;
  return value_ < base << 8;
}

bool AnsBits::open(ByteReader& in) {
  zeros_ = in.u8();
  const auto code = in.take(in.varuint());
  return in.ok() && zeros_ > 0 && state_.open(code, kBitBase, kBitBytes);
}

bool AnsBits::next() {
  const uint32_t state = state_.filled();
  const uint32_t ones = 256 - zeros_, rest = state & 255;
  const bool bit = rest < ones;
  state_.set(bit ? (state >> 8) * ones + rest : (state >> 8) * zeros_ + rest - ones);
  return bit;
}

// A byte's lowest two bits: how many bytes follow it, or 3 where it counts symbols that do not
// occur.
bool AnsSymbols::read_probabilities(ByteReader& in, uint32_t most_symbols) {
  const uint64_t count = in.varuint();
  if (!in.ok() || count == 0 || count > most_symbols) return false;
  std::array<uint32_t, kMaxSymbols> probability = {};
  for (uint64_t i = 0; i < count; ++i) {
    const uint8_t first = in.u8();
    const uint32_t more = first & 3u;
    if (more == 3) {
      i += first >> 2;
      if (i >= count) return false;
      continue;
    }
    probability[i] = first >> 2;
    for (uint32_t k = 0; k < more; ++k) probability[i] |= uint32_t{in.u8()} << (8 * k + 6);
  }
  for (uint32_t i = 0; i < kMaxSymbols; ++i) below_[i + 1] = below_[i] + probability[i];
  return in.ok() && below_.back() == 1u << kSymbolBits;
}

bool AnsSymbols::open(ByteReader& in, uint32_t most_symbols) {
  if (!read_probabilities(in, most_symbols)) return false;
  const auto code = in.take(in.varuint());
  return in.ok() && state_.open(code, kSymbolBase, kSymbolBytes);
}

uint8_t AnsSymbols::next() {
  const uint32_t state = state_.filled();
  const uint32_t rest = state & ((1u << kSymbolBits) - 1);
  uint32_t symbol = 0;
  for (uint32_t i = 1; i < kMaxSymbols; ++i) symbol += rest >= below_[i] ? 1 : 0;
  const uint32_t probability = below_[symbol + 1] - below_[symbol];
  state_.set((state >> kSymbolBits) * probability + rest - below_[symbol]);
  return static_cast<uint8_t>(symbol);
}

}  // namespace reeb
