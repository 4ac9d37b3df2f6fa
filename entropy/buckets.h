// Magnitudes by buckets, so that a large one takes few decisions and its distribution within a
// bucket is nearly even.
#pragma once

#include <bit>
#include <cstdint>

namespace reeb {

/// Eight buckets of one value each, then kPerOctave (a power of two up to 8) to the octave.
template <uint32_t kPerOctave>
struct Buckets {
  static constexpr uint32_t kSingles = 8;

  /// Bits that tell the place within bucket b.
  static constexpr uint32_t extra_bits(uint32_t b) {
    return b < kSingles ? 0 : (b - kSingles) / kPerOctave + kFirstExtra;
  }
  /// Least magnitude of bucket b.
  static constexpr uint32_t begin(uint32_t b) {
    return b < kSingles ? b : (kPerOctave + (b - kSingles) % kPerOctave) << extra_bits(b);
  }
  static constexpr uint32_t of(uint64_t magnitude) {
    if (magnitude < kSingles) return static_cast<uint32_t>(magnitude);
    const auto extra = static_cast<uint32_t>(std::bit_width(magnitude / kPerOctave)) - 1;
    return static_cast<uint32_t>(magnitude >> extra) - kPerOctave +
           kPerOctave * (extra - kFirstExtra) + kSingles;
  }

 private:
  static constexpr auto kFirstExtra =
      static_cast<uint32_t>(std::bit_width(kSingles / kPerOctave)) - 1;
};

}  // namespace reeb
