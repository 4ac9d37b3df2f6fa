// What is added to a reconstruction so that no coordinate misses the original by more than a bound.
#pragma once

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
  static constexpr uint64_t kEntryBytes = 24;  ///< of memory, for each

  Corrections() = default;
  /// `step` in world units.
  Corrections(uint32_t frames, double step) : step_(step), frames_(frames) {}

  /// Of `axis` of a vertex in frame t, which has none yet.
  void add(uint32_t vertex, uint32_t t, uint32_t axis, const Correction& correction) {
    frames_[t].push_back({vertex, axis, correction});
  }

  /// Corrects frame t; vertex v lies at xyz + v * stride.
  void apply(uint32_t t, float* xyz, size_t stride) const {
    if (frames_.empty()) return;
    for (const Entry& e : frames_[t]) {
      float& x = xyz[e.vertex * stride + e.axis];
      x = e.correction.apply(x, step_);
    }
  }

 private:
  struct Entry {
    uint32_t vertex;
    uint32_t axis;
    Correction correction;
  };
  static_assert(sizeof(Entry) == kEntryBytes);

  double step_ = 0;
  std::vector<std::vector<Entry>> frames_;
};

}  // namespace reeb
