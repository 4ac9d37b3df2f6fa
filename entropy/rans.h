// Asymmetric numeral systems (Duda's rANS) for symbols of a few classes with static frequencies:
// up to kRansLanes coders share one sequence of 16-bit words, so that a decoder works on as many
// symbols at once. Half the speed of copying memory, where the adaptive coders take ten times as
// long.
//
// A section holds integers. Each is a symbol (sign and bucket of its magnitude) and, for larger
// magnitudes, raw bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/buckets.h"
#include "entropy/raw_bits.h"

namespace reeb {

inline constexpr uint32_t kRansLanes = 16;
inline constexpr uint32_t kRansBits = 10;  ///< frequencies of a class sum to 2^kRansBits
inline constexpr uint32_t kRansClasses = 20;
inline constexpr uint32_t kRansSymbols = 123;
inline constexpr uint32_t kRansMaxMagnitude = (1u << 30) - 1;

using RansBuckets = Buckets<2>;

/// Symbol of an integer: 0, then by bucket, the negative sign first.
constexpr uint32_t rans_symbol(int32_t n) {
  const auto magnitude = static_cast<uint32_t>(n < 0 ? -n : n);
  return 2 * RansBuckets::of(magnitude) - (n < 0 ? 1 : 0);
}
/// The integer of a symbol that has no raw bits. Inlined always, see RansDecoder.
[[gnu::always_inline]] constexpr int32_t rans_integer(uint32_t symbol) {
  return static_cast<int32_t>(symbol >> 1) ^ -static_cast<int32_t>(symbol & 1);
}
constexpr uint32_t rans_symbol_bucket(uint32_t symbol) { return (symbol + 1) / 2; }
inline constexpr uint32_t kRansLastSingle =
    2 * (RansBuckets::kSingles - 1);  ///< symbols beyond have raw bits

/// Frequencies of one class; all zero for a class that does not occur.
using RansFrequencies = std::array<uint16_t, kRansSymbols>;
using RansTables = std::vector<RansFrequencies>;

using RansCounts = std::array<uint32_t, kRansSymbols>;

/// Frequencies near the counts; every symbol that occurs keeps at least 1.
RansFrequencies rans_frequencies(const RansCounts& counts);
/// Rounds all frequencies but the first to multiples of 2^shift plus 1, which are coded in fewer
/// bits. 0 stays 0, all others above it.
void coarsen(uint32_t shift, RansFrequencies& frequencies);

/// Gathers integers in coding order, then writes the section.
class RansEncoder {
 public:
  /// `lanes` <= kRansLanes.
  explicit RansEncoder(uint32_t lanes) : lanes_(lanes) {}

  /// `lane` < lanes, `cls` < kRansClasses, |n| <= kRansMaxMagnitude.
  void put(uint32_t lane, uint32_t cls, int32_t n) {
    items_.push_back({n, static_cast<uint8_t>(lane), static_cast<uint8_t>(cls)});
  }
  /// The same under the decoder's name, for syntax that serves both; returns `n`.
  int32_t code(uint32_t lane, uint32_t cls, int32_t n) {
    put(lane, cls, n);
    return n;
  }
  /// Frequencies of what was put so far, as coarse as is worth it.
  RansTables tables() const;
  std::vector<uint8_t> finish() const;

 private:
  struct Item {
    int32_t n;
    uint8_t lane;
    uint8_t cls;
  };
  uint32_t lanes_;
  std::vector<Item> items_;
};

/// Where a decoder stands.
struct RansCursor {
  uint32_t state[kRansLanes] = {};
  const uint32_t* slots = nullptr;  ///< [class][2^kRansBits]: symbol, place in its range, frequency
  const uint16_t* words = nullptr;
  size_t at = 0;   ///< next word; kRansLanes words from there may be read
  size_t end = 0;  ///< the words that are there
};

/// Reads a section. Damaged bytes give any integers but never a read beyond them. What is called
/// for every integer is inlined always: it may be compiled for several instruction sets, of which
/// the linker must not choose one.
class RansDecoder {
 public:
  /// False where the front of the section, of `lanes` <= kRansLanes, is malformed.
  bool open(std::span<const uint8_t> section, uint32_t lanes);

  /// The next integer; lanes and classes as the encoder put them. At most kRansLanes calls between
  /// calls of `settle`.
  [[gnu::always_inline]] int32_t get(uint32_t lane, uint32_t cls) {
    uint32_t x = cursor_.state[lane];
    const uint32_t slot = cursor_.slots[(cls << kRansBits) | (x & ((1u << kRansBits) - 1))];
    x = (slot & 0xFFF) * (x >> kRansBits) + (slot >> 12 & 0xFFF);
    const bool low = x < 1u << 16;
    x = low ? x << 16 | cursor_.words[cursor_.at] : x;
    cursor_.at += low ? 1 : 0;
    cursor_.state[lane] = x;
    const uint32_t symbol = slot >> 24;
    return symbol > kRansLastSingle ? large(symbol) : rans_integer(symbol);
  }

  /// The next integer; `n` is ignored.
  int32_t code(uint32_t lane, uint32_t cls, int32_t /*n*/) {
    const int32_t out = get(lane, cls);
    settle();
    return out;
  }

  /// Keeps the place within the words.
  [[gnu::always_inline]] void settle() {
    if (cursor_.at > cursor_.end) {
      cursor_.at = cursor_.end;
      overrun_ = true;
    }
  }

  /// For kernels that decode all lanes at once, as `get` does one after another.
  RansCursor& cursor() { return cursor_; }
  /// The integer of a symbol above kRansLastSingle, whose raw bits are next.
  int32_t large(uint32_t symbol);

  /// True once more was read than there is.
  bool overrun() const { return overrun_ || raw_.overrun(); }

 private:
  RansCursor cursor_;
  std::vector<uint32_t> slots_;
  std::vector<uint16_t> words_;  ///< and as many zeros behind them as may be read before `settle`
  RawBitReader raw_{{}};
  bool overrun_ = false;
};

}  // namespace reeb
