// The frames of a lossless group, each kept once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace reeb {

class ExactFrames {
 public:
  /// Appends a frame, [row][xyz].
  void add(std::vector<float> frame) {
    index_.push_back(stored_count());
    distance_.push_back(0);
    stored_.push_back(std::move(frame));
  }
  /// Appends a copy of the frame `distance` (1 .. frame_count()) before.
  void repeat(uint32_t distance) {
    index_.push_back(index_[index_.size() - distance]);
    distance_.push_back(distance);
  }

  uint32_t frame_count() const { return static_cast<uint32_t>(index_.size()); }
  /// How many frames before frame t the one is that it is a copy of; 0 where it is none.
  uint32_t distance(uint32_t t) const { return distance_[t]; }
  uint32_t stored_count() const { return static_cast<uint32_t>(stored_.size()); }
  /// The frames that are not copies, in order.
  const std::vector<float>& stored(uint32_t i) const { return stored_[i]; }
  const std::vector<float>& operator[](uint32_t t) const { return stored_[index_[t]]; }

  /// Writes row r of frame t to xyz + output[r] * stride.
  void frame(uint32_t t, std::span<const uint32_t> output, float* xyz, size_t stride) const {
    const float* from = stored_[index_[t]].data();
    for (size_t row = 0; row < output.size(); ++row, from += 3) {
      float* to = xyz + output[row] * stride;
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
    }
  }

 private:
  std::vector<uint32_t> index_;     ///< of each frame, among the stored ones
  std::vector<uint32_t> distance_;  ///< of each frame
  std::vector<std::vector<float>> stored_;
};

}  // namespace reeb
