// Normals that follow from the positions of a frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/attributes/site_mesh.h"

namespace reeb {

/// Unit normals of vertices or wedges, area-weighted over their triangles, (0, 0, 0) where those
/// have no area. `xyz`: of the vertices.
std::vector<float> computed_normals(const SiteMesh& sites, std::span<const float> xyz);

}  // namespace reeb
