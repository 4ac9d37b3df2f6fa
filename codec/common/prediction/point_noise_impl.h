// How exact reference positions are, for the kernels in binary64 and in binary32.
#pragma once

namespace reeb {

namespace {

/// Variance of a point's place among its neighbours, whose mean squared distance is `spread`: that
/// of half a grid unit, and the surface's bending, relative to the distance.
template <class Value, class Number>
inline Value point_noise(const Value& spread, Number bending) {
  constexpr Number kGridVariance = 0.25;
  return kGridVariance + bending * spread;
}

}  // namespace

}  // namespace reeb
