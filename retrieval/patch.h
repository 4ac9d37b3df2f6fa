// Manifold patches of a surface: their topology, and cuts that simplify it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmentation/surface.h"

namespace reeb::retrieval {

using segmentation::kNone;
using segmentation::Point;
using segmentation::Surface;
using segmentation::Triple;

using Loop = std::vector<uint32_t>;  ///< vertices around, the last one next to the first

/// A connected manifold with boundary, whatever the surface was that it comes from.
struct Patch {
  Surface surface;
  std::vector<Loop> boundaries;    ///< longest first
  std::vector<uint32_t> original;  ///< per triangle, that of the surface; kNone where it is a cap's
  double area = 0;                 ///< without caps
  int euler_characteristic = 0;

  bool is_disc() const { return boundaries.size() == 1 && euler_characteristic == 1; }
  bool is_annulus() const { return boundaries.size() == 2 && euler_characteristic == 0; }
  /// As many handles, twice counted, or crosscaps, as the patch has.
  int handles() const { return 2 - static_cast<int>(boundaries.size()) - euler_characteristic; }
};

/// The patches that some triangles of a surface form: they hang together at edges between exactly
/// two of them, but for those in `cut` (per edge of the surface; empty = none). Vertices where more
/// than one fan of a patch meets are taken apart. In order of their first triangle.
std::vector<Patch> glue(const Surface& surface, std::span<const uint32_t> triangles,
                        const std::vector<bool>& cut = {});

double loop_length(const Surface& surface, const Loop& loop);

/// A fan from the middle of each boundary but those numbered below `keep`.
Patch cap_boundaries(const Patch& patch, size_t keep);

/// The patch cut along edges until it is a disc. It has a boundary. The cut is what a spanning tree
/// of the triangles does not cross, without its loose ends (X. Gu, S. Gortler, H. Hoppe, "Geometry
/// images", 2002).
Patch cut_to_disc(const Patch& patch);

/// A patch without boundary as two or more with one: what is nearer to one or the other of two
/// vertices that are far apart.
std::vector<Patch> halve(const Patch& patch);

}  // namespace reeb::retrieval
