// Coding of PCA coefficients and of the basis, the same code for encoder and decoder.
//
// A coefficient is predicted from the vertices before it on the traversal, by parallelograms, by
// the mean of the neighbours, or not at all, whichever the encoder found best for the component. A
// basis column, and the mean trajectory, is predicted along time on each axis by differences of
// order 0, 1 or 2. Residuals go to an adaptive arithmetic coder whose context is the size of those
// nearby.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "conformance/rd/peers/traversal.h"
#include "entropy/integer_coder.h"

namespace reeb::conformance {

/// Counts the bits that a range coder would write.
class BitCounter {
 public:
  bool code(bool bit, Probability p1) {
    const double p = p1 / 65536.0;
    bits_ -= std::log2(bit ? p : 1 - p);
    return bit;
  }
  double bits() const { return bits_; }

 private:
  double bits_ = 0;
};

/// Integers whose expected magnitude is known, in quarters.
class ResidualModel {
 public:
  template <class Coder>
  int32_t code(Coder& coder, uint32_t expected_quarters, int32_t value) {
    const auto at = std::min<size_t>(std::bit_width(expected_quarters), models_.size() - 1);
    return models_[at].code(coder, value);
  }

 private:
  std::array<SignedModel, 12> models_;
};

enum class SurfacePrediction : uint32_t { kParallelogram, kMean, kNone };

class PcaCoder {
 public:
  /// Keeps a reference to `traversal`.
  explicit PcaCoder(const Traversal& traversal) : traversal_(traversal) {}

  /// One component in units of the quantization step, by vertex; `values` becomes what is decoded.
  template <class Coder>
  void code_coefficients(Coder& coder, SurfacePrediction prediction, std::vector<double>& values) {
    prediction = static_cast<SurfacePrediction>(
        surface_mode_.code(coder, static_cast<uint32_t>(prediction)));
    std::vector<int32_t> residual(values.size());
    uint32_t running = 0;  // mean magnitude along the order, times 16
    for (uint32_t i = 0; i < traversal_.order.size(); ++i) {
      const uint32_t v = traversal_.order[i];
      const double guess = predict(prediction, i, values);
      const auto wanted = static_cast<int32_t>(std::lround(values[v] - guess));
      residual[v] = coefficients_.code(coder, expected(i, residual, running / 4), wanted);
      values[v] = guess + residual[v];
      running += magnitude(residual[v]) - running / 16;
    }
  }

  /// A basis column or the mean trajectory, [frame][axis], in units of its step; as above.
  template <class Coder>
  void code_trajectory(Coder& coder, uint32_t order, std::vector<double>& values) {
    order = temporal_mode_.code(coder, order);
    std::vector<int32_t> residual(values.size(), 0);
    for (size_t i = 0; i < values.size(); ++i) {
      const double guess = extrapolate(order, i, values);
      const auto wanted = static_cast<int32_t>(std::lround(values[i] - guess));
      const uint32_t near = i < 6 ? (i < 3 ? 64 : 4 * magnitude(residual[i - 3]))
                                  : 2 * (magnitude(residual[i - 3]) + magnitude(residual[i - 6]));
      residual[i] = trajectories_.code(coder, near, wanted);
      values[i] = guess + residual[i];
    }
  }

  /// What code_coefficients predicts at place i of the order from the values before it.
  double predict(SurfacePrediction prediction, uint32_t i, const std::vector<double>& values) const;

  /// What code_trajectory predicts for value i.
  static double extrapolate(uint32_t order, size_t i, const std::vector<double>& values);

 private:
  /// Larger ones would only widen the context.
  static uint32_t magnitude(int32_t n) { return std::min<uint32_t>(std::abs(n), 1u << 20); }

  /// Mean magnitude of the neighbours before place i, in quarters; of those just coded without any.
  uint32_t expected(uint32_t i, const std::vector<int32_t>& residual, uint32_t running) const;

  const Traversal& traversal_;
  ExpGolombModel surface_mode_, temporal_mode_;
  ResidualModel coefficients_, trajectories_;
};

}  // namespace reeb::conformance
