#include "codec/dec/attributes/computed_normals.h"

#include "codec/dec/normals.h"

namespace reeb {

std::vector<float> computed_normals(const SiteMesh& sites, std::span<const float> xyz) {
  std::vector<float> of_wedges;
  for (const uint32_t v : sites.vertex) {
    const auto at = xyz.begin() + 3 * static_cast<ptrdiff_t>(v);
    of_wedges.insert(of_wedges.end(), at, at + 3);
  }
  const float* positions = sites.vertex.empty() ? xyz.data() : of_wedges.data();
  std::vector<double> sums(size_t{3} * sites.count);
  std::vector<float> out(size_t{3} * sites.count);
  vertex_normals(sites.triangles, positions, 3, sums, out.data(), 3);
  return out;
}

}  // namespace reeb
