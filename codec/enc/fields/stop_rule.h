// When to stop coding further temporal components.
#pragma once

#include <cmath>
#include <cstdint>

namespace reeb {

/// Keeps the number of components with the lowest cost seen.
class StopRule {
 public:
  StopRule(uint32_t frames, double lambda) : lambda_(lambda), basis_weight_(6.0 * frames) {}

  /// Adds a component: energy before, squared error after, bits spent (all in units of q). False:
  /// stop.
  bool add(double energy, double error, double bits) {
    ++count_;
    cost_ += error + basis_weight_ / 12 - energy + lambda_ * (bits + basis_bits(energy));
    if (cost_ < best_cost_) {
      best_cost_ = cost_;
      best_count_ = count_;
    }
    return count_ - best_count_ < kPatience;
  }
  /// Of a component's basis vector, estimated.
  double basis_bits(double energy) const {
    return basis_weight_ * 0.5 * std::log2(1 + 6 * energy / basis_weight_);
  }
  uint32_t best() const { return best_count_; }

 private:
  /// Components without gain after which the search for their number ends.
  static constexpr uint32_t kPatience = 8;
  double lambda_;
  double basis_weight_;  ///< about twice the 3F values of a basis vector, whose bits are estimated
  double cost_ = 0;
  double best_cost_ = 0;
  uint32_t count_ = 0;
  uint32_t best_count_ = 0;
};

}  // namespace reeb
