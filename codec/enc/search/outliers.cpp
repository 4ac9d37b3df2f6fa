#include "codec/enc/search/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace reeb {

namespace {

constexpr size_t kSample = 1 << 16;  ///< coordinates of an axis that are looked at
constexpr double kShare = 0.05;      ///< of them, at either end, that may be outliers
constexpr double kFar = 32;          ///< times the size of the rest, from its middle

/// Where all but a few coordinates of an axis are.
struct Range {
  double least = 0, most = 0;
  double size() const { return most - least; }
};

Range range_of(const Shot& shot, size_t axis) {
  const size_t count = shot.positions.size() / 3;
  const size_t stride = count / kSample + 1;
  std::vector<float> sample;
  for (size_t i = 0; i < count; i += stride) sample.push_back(shot.positions[3 * i + axis]);
  const auto at = [&](double share) {
    const auto place = static_cast<ptrdiff_t>(share * static_cast<double>(sample.size() - 1));
    std::nth_element(sample.begin(), sample.begin() + place, sample.end());
    return static_cast<double>(sample[static_cast<size_t>(place)]);
  };
  return {at(kShare), at(1 - kShare)};
}

class Tamer {
 public:
  explicit Tamer(const Shot& shot) {
    for (size_t axis = 0; axis < 3; ++axis) {
      ranges_[axis] = range_of(shot, axis);
      reach_ = std::max(reach_, kFar * ranges_[axis].size());
    }
  }

  bool is_far(float x, size_t axis) const {
    const Range& range = ranges_[axis];
    const double middle = range.least + range.size() / 2;
    return std::abs(static_cast<double>(x) - middle) > reach_;
  }
  /// Without extent nothing is far.
  bool any_far(const Shot& shot) const {
    if (reach_ == 0) return false;
    for (size_t i = 0; i < shot.positions.size(); ++i) {
      if (is_far(shot.positions[i], i % 3)) return true;
    }
    return false;
  }
  /// Each stays where it was in the frame before, or moves to the border of its range.
  void tame(Shot& shot) const {
    const size_t frame = shot.frame(0).size();
    for (size_t i = 0; i < shot.positions.size(); ++i) {
      float& x = shot.positions[i];
      const Range& range = ranges_[i % 3];
      if (!is_far(x, i % 3)) continue;
      x = i >= frame ? shot.positions[i - frame]
                     : static_cast<float>(x > range.most ? range.most : range.least);
    }
  }

 private:
  std::array<Range, 3> ranges_;
  double reach_ = 0;
};

}  // namespace

std::optional<Sequence> without_outliers(const Sequence& sequence) {
  std::optional<Sequence> out;
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    const Tamer tamer(sequence.shots[i]);
    if (!tamer.any_far(sequence.shots[i])) continue;
    if (!out) out = sequence;
    tamer.tame(out->shots[i]);
  }
  return out;
}

}  // namespace reeb
