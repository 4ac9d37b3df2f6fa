// The sum of components that makes positions: the few with large values in binary32, all others as
// 16-bit integers, whose sum is exact in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/base/raw_vector.h"
#include "codec/common/simd/instruction_set.h"
#include "codec/common/synthesis/sum_kernels.h"

namespace reeb {

class ComponentSum {
 public:
  using Planes = std::vector<std::vector<float>>;

  ComponentSum() = default;
  /// `planes`: K components of V values, in units of the quantization step `q`; `basis`: K
  /// components of 3F values, [time][axis], a vector of norm near 1 each; `output`: row of the
  /// planes -> vertex, 0 .. V - 1.
  ComponentSum(Planes planes, const std::vector<std::vector<double>>& basis, double q,
               std::span<const uint32_t> output);

  /// Positions of all vertices in frames first .. first + count - 1, frame t at xyz + t *
  /// frame_stride, vertex v at v * stride from there. `mean`: 3F values, added last.
  void frames(uint32_t first, uint32_t count, const double* mean, float* xyz, size_t frame_stride,
              size_t stride) const;

  uint32_t component_count() const { return wide_ + narrow_; }
  /// How many components, the first ones, are summed in binary32.
  uint32_t wide_count() const { return wide_; }
  /// What one unit of the plane adds to row = time * 3 + axis: world units, as it is summed.
  double basis(size_t row, uint32_t component) const;
  /// False where a value of the basis is beyond binary32.
  bool finite() const;

 private:
  void choose_narrow(const Planes& planes, const std::vector<std::vector<double>>& basis);
  void fill_basis(const std::vector<std::vector<double>>& basis, double q);
  void fill_tiles(Planes& planes, std::span<const uint32_t> output);
  uint32_t pairs() const { return (narrow_ + 1) / 2; }

  uint32_t vertices_ = 0;
  uint32_t wide_ = 0, narrow_ = 0;
  float unit_ = 0;                      ///< world units per unit of the sum of integers
  RawVector<float> wide_tiles_;         ///< [tile][component][vertex], kTileRows vertices a tile
  RawVector<uint32_t> narrow_tiles_;    ///< [tile][pair][vertex]: two 16-bit integers
  std::vector<float> wide_basis_;       ///< [time][axis][component]
  std::vector<uint32_t> narrow_basis_;  ///< [time][axis][pair]
  SumKernels kernels_ = fastest_kernels<SumKernels>();
};

}  // namespace reeb
