#include "codec/common/attributes/site_mesh.h"

#include <algorithm>

#include "codec/common/mesh/faces.h"
#include "codec/common/reference/face_order.h"

namespace reeb {

namespace {

/// The faces as fans, whose corners `site(corner)` names, without triangles that repeat a site.
template <class Site>
std::vector<uint32_t> fans(const std::vector<uint32_t>& face_sizes, Site site) {
  std::vector<uint32_t> out;
  size_t first = 0;
  for (const uint32_t size : face_sizes) {
    for (size_t i = 1; i + 1 < size; ++i) {
      const uint32_t a = site(first), b = site(first + i), c = site(first + i + 1);
      if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
    }
    first += size;
  }
  return out;
}

}  // namespace

SiteMesh vertex_sites(const ShotSurface& surface) {
  const Connectivity& c = surface.connectivity;
  return {
      c.vertex_count, fans(c.face_sizes, [&](size_t i) { return c.corners[i]; }), surface.grid, {}};
}

SiteMesh wedge_sites(const ShotSurface& surface, const Wedges& wedges) {
  const Connectivity& c = surface.connectivity;
  SiteMesh out;
  out.count = wedges.count();
  out.triangles = fans(c.face_sizes, [&](size_t i) { return wedges.of_corner[i]; });
  out.grid.reserve(size_t{3} * out.count);
  for (const uint32_t v : wedges.vertex) {
    const auto at = surface.grid.begin() + 3 * static_cast<ptrdiff_t>(v);
    out.grid.insert(out.grid.end(), at, at + 3);
  }
  out.vertex = wedges.vertex;
  return out;
}

SiteMesh face_sites(const ShotSurface& surface) {
  const Connectivity& c = surface.connectivity;
  SiteMesh out;
  out.count = static_cast<uint32_t>(c.face_sizes.size());
  out.triangles = FaceOrderContext(c).dual_triangles();
  size_t corner = 0;
  for (const uint32_t size : c.face_sizes) {
    int64_t sum[3] = {0, 0, 0};
    for (const size_t end = corner + size; corner < end; ++corner) {
      for (size_t i = 0; i < 3; ++i) sum[i] += surface.grid[size_t{c.corners[corner]} * 3 + i];
    }
    for (const int64_t x : sum) out.grid.push_back(static_cast<int32_t>(x / std::max(size, 1u)));
  }
  return out;
}

SiteMesh shot_site() { return {1, {}, {0, 0, 0}, {}}; }

}  // namespace reeb
