#include "codec/enc/attributes/integer_encoder.h"

#include <algorithm>
#include <utility>

namespace reeb {

namespace {

/// The plane through the middle of all sites that mirrors most triangles, if it does enough.
std::optional<MirrorPlane> find_plane(const SiteMesh& sites) {
  constexpr size_t kMostTriangles = 8;  // to each that is mirrored
  std::optional<MirrorPlane> out;
  size_t most = sites.triangles.size() / 3 / kMostTriangles;
  for (uint32_t axis = 0; axis < 3 && sites.count > 1; ++axis) {
    int32_t low = sites.grid[axis], high = low;
    for (size_t i = axis; i < sites.grid.size(); i += 3) {
      low = std::min(low, sites.grid[i]);
      high = std::max(high, sites.grid[i]);
    }
    const MirrorPlane plane{axis, static_cast<uint32_t>(low + high)};
    const size_t mirrored = MirrorSites(sites, plane).mirrored_triangles();
    if (mirrored <= most) continue;
    most = mirrored;
    out = plane;
  }
  return out;
}

}  // namespace

Status encode_integers(const AttributeHeader& header, const AttributeBody& body,
                       const ShotSurface& surface, const SiteMesh& sites,
                       std::vector<uint32_t>& integers, IntervalEncoder& coder) {
  IntervalEncoder plain = coder, mirrored = coder;
  Status s = code_integers(plain, header, body, surface, sites, integers);
  if (!s.ok()) return s;
  const auto size = [](IntervalEncoder copy) { return copy.finish().size(); };
  const std::optional<MirrorPlane> plane =
      is_category(header, body) ? std::nullopt : find_plane(sites);
  if (plane) s = code_integers(mirrored, header, body, surface, sites, integers, plane);
  coder = std::move(plane && size(mirrored) < size(plain) ? mirrored : plain);
  return s;
}

}  // namespace reeb
