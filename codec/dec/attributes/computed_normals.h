// Normals that follow from the positions of a frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/attributes/site_mesh.h"
#include "codec/common/attributes/turned_normal.h"

namespace reeb {

/// Unit normals of vertices or wedges, area-weighted over their triangles, (0, 0, 0) where those
/// have no area. `xyz`: of the vertices.
std::vector<float> computed_normals(const SiteMesh& sites, std::span<const float> xyz);

/// The axes at every site.
std::vector<NormalFrame> normal_frames(const SiteMesh& sites, std::span<const float> xyz);

/// Computed normals turned by `corrections`, [site][u, v].
std::vector<float> turned_normals(const SiteMesh& sites, std::span<const float> xyz,
                                  std::span<const float> corrections);
/// Bytes that takes at most, the normals included.
uint64_t turned_normals_memory(const SiteMesh& sites);

}  // namespace reeb
