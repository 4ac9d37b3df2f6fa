// Faces compared without regard to their order and first corners.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "codec/common/base/sequence.h"
#include "codec/common/mesh/connectivity.h"
#include "codec/dec/connectivity/connectivity_decoder.h"

namespace reeb {

class FaceSet {
 public:
  /// Keeps a reference to `faces`.
  explicit FaceSet(const Connectivity& faces);

  std::span<const uint32_t> corners(uint32_t face) const;

  /// Faces that Draco can carry: three corners or more, all different, not a repetition. Ascending.
  std::vector<uint32_t> regular() const;

  /// For each triangle of a decoded Draco mesh (`vertex_of`: our vertex of each point) the face of
  /// `faces` whose fan holds it, each fan triangle used once; the largest uint32 where there is
  /// none.
  std::vector<uint32_t> owners(const std::vector<uint32_t>& faces, const PointTriangles& mesh,
                               const std::vector<uint32_t>& vertex_of) const;

  /// Those of `faces` that `found` lacks, ascending; all of `faces` where `found` holds others.
  std::vector<uint32_t> missing(const std::vector<uint32_t>& faces, const Polygons& found) const;

 private:
  using Cycle = std::vector<uint32_t>;

  const Connectivity& faces_;
  std::vector<size_t> first_corner_;
};

}  // namespace reeb
