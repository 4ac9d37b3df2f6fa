// What the values of an attribute stand on: its *sites* - vertices, wedges, faces, or the shot -
// and the triangles along which values are predicted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/attributes/face_corners.h"
#include "codec/common/attributes/wedges.h"

namespace reeb {

/// The mesh of a shot as attributes see it: faces and grid positions in output order.
struct ShotSurface {
  const Connectivity& connectivity;
  std::vector<int32_t> grid;  ///< [vertex][xyz]
};

struct SiteMesh {
  uint32_t count = 0;
  std::vector<uint32_t> triangles;  ///< three different sites each
  std::vector<int32_t> grid;        ///< [site][xyz]
  std::vector<uint32_t> vertex;     ///< of each wedge; else empty
};

SiteMesh vertex_sites(const ShotSurface& surface);
SiteMesh wedge_sites(const ShotSurface& surface, const Wedges& wedges);
/// A face lies in the middle of its corners, rounded down.
SiteMesh face_sites(const ShotSurface& surface);
SiteMesh shot_site();

}  // namespace reeb
