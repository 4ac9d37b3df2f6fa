// What a scan, another program or a break does to a mesh: the changes that a search should not
// mind.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace reeb::conformance {

struct PlainMesh {
  std::vector<float> positions;  ///< x, y, z of each vertex
  std::vector<uint32_t> triangles;
};

/// Names that `make_variant` knows: rotated, scaled, noise_0.5 and noise_1 (normal deviation in
/// percent of the diagonal, along the normals), decimated_2 and decimated_10 (to that part of the
/// triangles), resampled (refined, then decimated to as many triangles), holes (ten, of 12 vertices
/// each), half (of the body, by a plane across its longest axis through the centroid).
const std::vector<std::string>& variant_names();

/// False where there is no such variant. The same mesh gives the same variant.
bool make_variant(const std::string& name, PlainMesh& mesh);

}  // namespace reeb::conformance
