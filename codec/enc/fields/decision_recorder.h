// Stands in for the range coder while the encoder has not yet decided how much it will send.
#pragma once

#include <cstdint>
#include <vector>

#include "entropy/range_coder.h"

namespace reeb {

/// -log2(p / 65536) in bits.
double cost_of(Probability p);

/// Same member `code` as the range coder; keeps the decisions and counts their cost.
class DecisionRecorder {
 public:
  bool code(bool bit, Probability p1) {
    decisions_.push_back(uint32_t{p1} << 1 | (bit ? 1u : 0u));
    bits_ += cost_of(bit ? p1 : static_cast<Probability>(65536 - p1));
    return bit;
  }

  double bits() const { return bits_; }
  size_t size() const { return decisions_.size(); }

  /// The first `count` decisions as range-coded bytes.
  std::vector<uint8_t> encode(size_t count) const;

 private:
  std::vector<uint32_t> decisions_;
  double bits_ = 0;
};

}  // namespace reeb
