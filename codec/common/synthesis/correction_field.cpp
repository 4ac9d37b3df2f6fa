#include "codec/common/synthesis/correction_field.h"

#include <algorithm>
#include <cstdlib>

#include "codec/common/base/integer_math.h"

namespace reeb {

namespace {

constexpr uint32_t kNearClasses = 8;
constexpr uint32_t kRateClasses = 14;
constexpr std::array<uint32_t, 6> kZeroEntries = {
    3 * 3 * kNearClasses * 3, kNearClasses* kNearClasses * 3, kRateClasses* kRateClasses,
    3 * 3 * kNearClasses * 3, kRateClasses* kRateClasses,     kRateClasses* kNearClasses * 3,
};
constexpr std::array<uint32_t, 3> kSignEntries = {5 * 5 * 5, 5 * 5 * 5, 5 * 5};

/// Class of a mean size in 1/16.
uint32_t near_class(uint32_t mean) {
  constexpr std::array<uint8_t, 33> kClass = {0, 1, 1, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5,
                                              6, 6, 6, 6, 6, 6, 6, 6, 7, 7, 7, 7, 7, 7, 7, 7};
  return kClass[std::min(mean, 32u)];
}

/// Logarithmic class of a share in 1/65536.
uint32_t rate_class(uint32_t rate) {
  return std::min(kRateClasses - 1, (log2_q5(rate + 48) - 5 * 32) / 24);
}

uint32_t size_of(int8_t value) { return static_cast<uint32_t>(std::abs(value)); }

/// -2 .. 2 to 0 .. 4.
uint32_t signed_class(int value) { return static_cast<uint32_t>(std::clamp(value, -2, 2) + 2); }

}  // namespace

CorrectionField::CorrectionField(const PredictionGraph& graph, uint32_t frames, uint64_t count)
    : graph_(graph),
      frames_(frames),
      row_size_(size_t{3} * (frames + kMargin)),
      frame_rate_(row_size_, 1 << 10),
      own_(row_size_, 0),
      near_size_(row_size_),
      near_sum_(row_size_),
      near_class_(row_size_),
      zero_(kZeroEntries, 3, kLimit),
      sign_(kSignEntries, 1, kLimit) {
  coded_.reserve(static_cast<size_t>(count) + 1);  // one more is met before it is refused
  first_.reserve(size_t{graph.size()} + 1);
  first_.push_back(0);
  density_.reserve(graph.size());
}

void CorrectionField::begin_row(uint32_t row) {
  const PredictionGraph::Row& r = graph_.rows[row];
  uint32_t density = 0;
  uint32_t active = 0;
  uint32_t weight = 0;
  for (uint32_t i = 0; i < r.count; ++i) {
    const uint32_t share = i < r.ring ? 2 : 1;
    weight += share;
    if (!has_some(r.neighbour[i])) continue;
    active += share;
    density += share * density_[r.neighbour[i]];
  }
  row_rate_ = weight > 0 ? density / weight : 0;
  near_density_ = rate_class(row_rate_);
  row_rate_ = std::max(row_rate_, 256u);
  const bool last_active = row > 0 && has_some(row - 1);
  active_context_ =
      (weight > 0 ? (4 * active + weight - 1) / weight : 2) * 2 + (last_active ? 1 : 0);
}

void CorrectionField::look_around(uint32_t row) {
  const PredictionGraph::Row& r = graph_.rows[row];
  std::fill(own_.begin(), own_.end(), int8_t{0});
  std::fill(near_size_.begin(), near_size_.end(), uint8_t{0});
  std::fill(near_sum_.begin(), near_sum_.end(), int8_t{0});
  uint32_t weight = 0;
  for (uint32_t i = 0; i < r.count; ++i) {
    const int share = i < r.ring ? 2 : 1;
    weight += static_cast<uint32_t>(share);
    for (size_t at = first_[r.neighbour[i]]; at < first_[r.neighbour[i] + 1]; ++at) {
      const uint32_t place = coded_[at].place();
      const int steps = coded_[at].steps();
      near_size_[place] = static_cast<uint8_t>(near_size_[place] + share * std::abs(steps));
      near_sum_[place] = static_cast<int8_t>(near_sum_[place] + share * steps);
    }
  }
  const uint32_t reciprocal = weight > 0 ? (16u << 16) / weight : 0;
  for (size_t at = 0; at < row_size_; ++at)
    near_class_[at] = static_cast<uint8_t>(near_class((near_size_[at] * reciprocal) >> 16));
}

void CorrectionField::finish_row() {
  const size_t corrected = coded_.size() - first_.back();
  first_.push_back(coded_.size());
  density_.push_back(static_cast<uint32_t>((uint64_t{corrected} << 16) / (3 * uint64_t{frames_})));
}

void CorrectionField::note(const Correction& coded, size_t at) {
  const int64_t steps = coded.replaced ? 2 : coded.steps;
  if (steps != 0) {
    const int64_t clamped = std::clamp<int64_t>(steps, -2, 2);
    own_[at] = static_cast<int8_t>(clamped);
    coded_.emplace_back(at, clamped);
  }
  const uint32_t share = steps != 0 ? 65535 : 0;
  const auto follow = [share](uint32_t& rate, uint32_t shift) {
    rate = share > rate ? rate + ((share - rate) >> shift) : rate - ((rate - share) >> shift);
  };
  follow(frame_rate_[at], 6);
  follow(row_rate_, 5);
}

CorrectionField::ZeroMixer::Prediction CorrectionField::predict_some(size_t at,
                                                                     uint32_t axis) const {
  const uint32_t before = size_of(own_[at - 3]);
  const uint32_t earlier = size_of(own_[at - 6]);
  // The two other axes: of this frame where they are coded already, else of the one before.
  const uint32_t other = size_of(own_[at - 1]);
  const uint32_t another = size_of(own_[at - 2]);
  const uint32_t near = near_class_[at];
  const uint32_t around = (near_class_[at - 3] + near_class_[at + 3] + 1u) / 2;
  const uint32_t frame = rate_class(frame_rate_[at]);
  const uint32_t row = rate_class(row_rate_);
  const uint32_t same_frame =
      near_class_[at - axis] + near_class_[at - axis + 1] + near_class_[at - axis + 2] - near;
  return zero_.predict(
      {((before * 3 + earlier) * kNearClasses + near) * 3 + std::min(2u, axis),
       (near * kNearClasses + around) * 3 + before, frame * kRateClasses + row,
       ((other * 3 + another) * kNearClasses + (same_frame + 1) / 2) * 3 + before,
       row * kRateClasses + near_density_, (frame * kNearClasses + near) * 3 + before},
      std::min(2u, before + (near > 0 ? 1 : 0)));
}

CorrectionField::SignMixer::Prediction CorrectionField::predict_negative(size_t at) const {
  const uint32_t before = signed_class(own_[at - 3]);
  const uint32_t earlier = signed_class(own_[at - 6]);
  const uint32_t near = signed_class(near_sum_[at]);
  const uint32_t around = signed_class((near_sum_[at - 3] + near_sum_[at + 3]) / 2);
  return sign_.predict(
      {(before * 5 + earlier) * 5 + near, (near * 5 + around) * 5 + before, before * 5 + near}, 0);
}

uint32_t CorrectionField::length_context(size_t at) const {
  return std::min(3u, size_of(own_[at - 3]) + (near_size_[at] > 2 ? 1 : 0));
}

}  // namespace reeb
