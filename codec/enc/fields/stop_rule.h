// When to stop coding further temporal components.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bitstream/element_bound.h"

namespace reeb {

/// Keeps the number of components with the lowest cost seen.
class StopRule {
 public:
  StopRule(uint32_t vertices, uint32_t frames, double lambda)
      : lambda_(lambda),
        basis_weight_(6.0 * frames),
        least_bits_(8 * (vertices + 3.0 * frames) / kElementsPerByte) {}

  /// Adds a component: energy before, squared error after, bits spent (all in units of q). False:
  /// stop.
  bool add(double energy, double error, double bits) {
    ++count_;
    distortion_ += error + basis_weight_ / 12 - energy;
    bits_ += bits + basis_bits(energy);
    const double cost = distortion_ + lambda_ * this->bits();
    if (cost < best_cost_) {
      best_cost_ = cost;
      best_count_ = count_;
    }
    return count_ - best_count_ < kPatience;
  }
  /// Of a component's basis vector, estimated.
  double basis_bits(double energy) const {
    return basis_weight_ * 0.5 * std::log2(1 + 6 * energy / basis_weight_);
  }
  /// Of all components so far, with what they are padded by.
  double bits() const { return std::max(bits_, count_ * least_bits_); }
  uint32_t best() const { return best_count_; }

 private:
  /// Components without gain after which the search for their number ends.
  static constexpr uint32_t kPatience = 8;
  double lambda_;
  double basis_weight_;  ///< about twice the 3F values of a basis vector, whose bits are estimated
  double least_bits_;    ///< that a component takes, padded where it is coded in less
  double distortion_ = 0;
  double bits_ = 0;
  double best_cost_ = 0;
  uint32_t count_ = 0;
  uint32_t best_count_ = 0;
};

}  // namespace reeb
