// Local thickness of a surface.
#pragma once

#include <vector>

#include "retrieval/patch.h"

namespace reeb::retrieval {

/// Per vertex, the radius of the largest ball, on the thinner side, that touches the surface there
/// and has no part of it inside, at most `limit` (> 0): shrinking balls (J. Ma, S. Bae, S. Choi,
/// "3D medial axis point approximation using nearest neighbors and the normal field", 2012), for a
/// sample of at most some 2,500 vertices; the others take the value of a sampled one nearby. It
/// does not change with the pose, nor with the orientation of the triangles.
std::vector<double> local_thickness(const Surface& surface, double limit);

}  // namespace reeb::retrieval
