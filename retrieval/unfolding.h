// Charts unfolded into the plane by harmonic maps.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "retrieval/patch.h"

namespace reeb::retrieval {

/// A chart in the plane.
struct Unfolding {
  /// Per triangle, the places of its corners. A disc fills the unit disc, its boundary spread over
  /// the circle by length. An annulus is unrolled: (u, w), u from 0 at the longer boundary to
  /// `height` at the other one, w the turns about the axis; the corners of a triangle at the seam
  /// stay together, one turn further.
  std::vector<Eigen::Matrix<double, 2, 3>> corners;
  double height = 0;  ///< conformal modulus of an annulus: a cylinder's length over its girth
};

/// Unfolds a disc or an annulus. Cotangent weights, made positive where a triangle would fold.
/// False where the equations have no answer.
bool unfold(const Patch& patch, Unfolding& out);

}  // namespace reeb::retrieval
