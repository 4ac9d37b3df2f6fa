// What is added to a reconstruction so that no coordinate misses the original by more than a bound.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace reeb {

/// How one coordinate is corrected: moved by a whole number of steps, or replaced.
struct Correction {
  int64_t steps = 0;      ///< |steps| < 2^53; 0 = as it is, unless replaced
  bool replaced = false;  ///< no number of steps will do: `value` takes its place
  float value = 0;        ///< only where replaced, else 0

  bool none() const { return steps == 0 && !replaced; }
  /// The corrected coordinate: binary64 arithmetic, rounded once to binary32.
  float apply(float base, double step) const {
    if (replaced) return value;
    return static_cast<float>(static_cast<double>(base) + static_cast<double>(steps) * step);
  }
};

/// The corrections of a group of frames, most coordinates having none.
class Corrections {
 public:
  static constexpr uint64_t kEntryBytes = 16;  ///< of memory, for each
  static constexpr uint64_t kMaxCount = 0xFFFFFFFE;

  Corrections() = default;
  /// `step` in world units; `count`: how many will be added, where that is known.
  Corrections(uint32_t frames, double step, uint64_t count = 0)
      : step_(step), latest_(frames, kNone) {
    entries_.reserve(static_cast<size_t>(count));
  }

  /// Of `axis` of a vertex in frame t, which has none yet. At most kMaxCount in all.
  void add(uint32_t vertex, uint32_t t, uint32_t axis, const Correction& c) {
    const int64_t what = c.replaced ? std::bit_cast<int32_t>(c.value) : c.steps;
    const uint32_t place = vertex * 3 + axis;
    const auto index = static_cast<uint32_t>(entries_.size());
    entries_.push_back({what, c.replaced ? place | kReplaced : place, latest_[t]});
    latest_[t] = index;
  }

  /// Corrects frame t; vertex v lies at xyz + v * stride.
  void apply(uint32_t t, float* xyz, size_t stride) const {
    if (latest_.empty()) return;
    for (uint32_t at = latest_[t]; at != kNone; at = entries_[at].before) {
      const Entry& e = entries_[at];
      const uint32_t place = e.place & ~kReplaced;
      float& x = xyz[place / 3 * stride + place % 3];
      x = correction(e).apply(x, step_);
    }
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;
  static constexpr uint32_t kReplaced = 1u << 31;

  struct Entry {
    int64_t what;     ///< steps, or the bits of what replaces the coordinate
    uint32_t place;   ///< vertex * 3 + axis, and whether the coordinate is replaced
    uint32_t before;  ///< the correction of the same frame that was added before this one
  };
  static_assert(sizeof(Entry) == kEntryBytes);

  static Correction correction(const Entry& e) {
    if ((e.place & kReplaced) == 0) return {e.what, false, 0};
    return {0, true, std::bit_cast<float>(static_cast<int32_t>(e.what))};
  }

  double step_ = 0;
  std::vector<Entry> entries_;
  std::vector<uint32_t> latest_;  ///< correction of each frame
};

}  // namespace reeb
