// How an unfolding stretches a chart, from the middle outwards.
#pragma once

#include <array>
#include <span>

#include "retrieval/unfolding.h"

namespace reeb::retrieval {

inline constexpr int kRings = 16;

/// Functions of the radius, a value for each of kRings rings that have equal parts of the surface's
/// area: in a disc from its centre outwards, in an annulus from its longer boundary to the shorter.
struct Rings {
  std::array<double, kRings> area{};   ///< natural logarithm of area in the plane over area on the
                                       ///< surface, both as parts of the whole; kMinAreaStretch ..
  std::array<double, kRings> value{};  ///< mean by area of values given per triangle
  std::array<double, kRings> angle{};  ///< natural logarithm of the larger over the smaller
                                       ///< singular value of the map, mean by area; 0 ..
                                       ///< kMaxAngleStretch
};

inline constexpr double kMinAreaStretch = -12;
inline constexpr double kMaxAngleStretch = 3;

/// `values` has one value per triangle of the patch; those of caps are not used.
Rings measure_rings(const Patch& patch, const Unfolding& unfolding, std::span<const double> values);

}  // namespace reeb::retrieval
