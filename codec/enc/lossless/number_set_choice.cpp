#include "codec/enc/lossless/number_set_choice.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

namespace reeb {

namespace {

constexpr size_t kSamples = 256;
constexpr double kMinGain = 0.5;       ///< bits per value that decimals must be sparser by
constexpr size_t kMaxStrangers = 512;  ///< one value in so many may lie outside the set

/// Digits and places of the shortest decimal that rounds to a number.
struct Shape {
  uint32_t digits = 1;
  uint32_t decimals = 0;
  void extend(const Shape& other) {
    digits = std::max(digits, other.digits);
    decimals = std::max(decimals, other.decimals);
  }
  bool operator==(const Shape&) const = default;
};

Shape shape_of(float x) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, std::abs(x), std::chars_format::scientific);
  const char* e = std::find(text, end.ptr, 'e');
  int exponent = 0;
  std::from_chars(e[1] == '+' ? e + 2 : e + 1, end.ptr, exponent);
  const auto digits = static_cast<int>(e - text) - (e - text > 1 ? 1 : 0);
  return {static_cast<uint32_t>(digits), static_cast<uint32_t>(std::max(0, digits - 1 - exponent))};
}

bool allowed(const Shape& s) {
  return s.digits <= NumberSet::kMaxDigits && s.decimals <= NumberSet::kMaxDecimals;
}

/// How much sparser the set is than binary32 near a number, in bits.
double gain_near(const NumberSet& set, float x) {
  const float size = std::max(std::abs(x), 1e-30f);
  const int64_t n = set.nearest(static_cast<double>(size));
  if (!set.valid(n + 1)) return 0;
  const double step = static_cast<double>(set.number(n + 1)) - static_cast<double>(set.number(n));
  const float next = std::nextafter(size, std::numeric_limits<float>::max());
  return std::log2(step / (static_cast<double>(next) - static_cast<double>(size)));
}

class Chooser {
 public:
  Chooser(const ExactFrames& frames, uint32_t axis) : frames_(frames), axis_(axis) {
    const size_t total = frames.stored_count() * (frames.stored(0).size() / 3);
    for (size_t i = 0; i < kSamples; ++i) samples_.push_back(value(total * i / kSamples));
    strangers_allowed_ = total / kMaxStrangers;
  }

  NumberSet choose() {
    Shape shape;
    for (const float x : samples_) shape.extend(shape_of(x));
    while (pays(shape)) {
      NumberSet set(shape.digits, shape.decimals);
      Shape wider = shape;
      if (fits(set, wider)) return set;
      if (wider == shape) break;
      shape = wider;
    }
    return {};
  }

 private:
  float value(size_t i) const {
    const size_t rows = frames_.stored(0).size() / 3;
    return frames_.stored(static_cast<uint32_t>(i / rows))[i % rows * 3 + axis_];
  }

  bool pays(const Shape& shape) const {
    if (!allowed(shape)) return false;
    const NumberSet set(shape.digits, shape.decimals);
    double gain = 0;
    for (const float x : samples_) gain += gain_near(set, x);
    return gain >= kMinGain * static_cast<double>(samples_.size());
  }

  /// True where all but few values are of the set; else `shape` may be extended to one worth a try.
  bool fits(const NumberSet& set, Shape& shape) const {
    size_t strangers = 0;
    for (uint32_t t = 0; t < frames_.stored_count(); ++t) {
      const std::vector<float>& frame = frames_.stored(t);
      for (size_t i = axis_; i < frame.size(); i += 3) {
        bool found = false;
        set.find(frame[i], found);
        if (found) continue;
        Shape wider = shape;
        wider.extend(shape_of(frame[i]));
        if (wider != shape && pays(wider)) {
          shape = wider;
          return false;
        }
        if (++strangers > strangers_allowed_) return false;
      }
    }
    return true;
  }

  const ExactFrames& frames_;
  uint32_t axis_;
  std::vector<float> samples_;
  size_t strangers_allowed_;
};

}  // namespace

NumberSet choose_number_set(const ExactFrames& frames, uint32_t axis) {
  return Chooser(frames, axis).choose();
}

}  // namespace reeb
