// A reference mesh on its way into or out of a stream, and what its syntax functions share.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/base/sequence.h"
#include "codec/common/mesh/connectivity.h"

namespace reeb {

/// A *point* is what triangles of the edgebreaker share; several may be one vertex.
struct MeshState {
  uint32_t vertex_count = 0;
  uint32_t face_count = 0;
  uint32_t point_count = 0;
  std::vector<uint32_t> triangles;        ///< three points each, by the edgebreaker
  std::vector<int32_t> point_grid;        ///< [point][xyz]
  std::vector<uint32_t> vertex_of_point;  ///< coding numbering; rises by one at each new vertex
  std::vector<int32_t> grid;              ///< [coding vertex][xyz]
  std::vector<uint8_t> diagonal;          ///< per half-edge: inside a polygon
  Polygons joined;                        ///< faces out of `triangles`, corners are points
  Polygons listed;                        ///< all other faces, corners are coding vertices
};

/// Triangles of a complete state in coding numbering: those, then the fans of the listed faces;
/// those with two equal corners are left out.
std::vector<uint32_t> collect_triangles(const MeshState& state);

/// The faces of a complete state in the order of its parts, corners renamed by `output_index`.
Connectivity collect_faces(const MeshState& state, const std::vector<uint32_t>& output_index);

/// Entry i of a list that is either complete or i entries long.
template <class T>
T& slot(std::vector<T>& list, size_t i) {
  if (i == list.size()) list.emplace_back();
  return list[i];
}

template <class Coder>
inline constexpr bool kDecodes = requires(Coder& coder) {
  coder.overrun();
};

/// True when a decoder has been asked for more than its bytes can hold; never for an encoder.
template <class Coder>
bool ran_dry(const Coder& coder) {
  if constexpr (kDecodes<Coder>) return coder.overrun();
  return false;
}

}  // namespace reeb
