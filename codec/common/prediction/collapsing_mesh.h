// A triangle mesh whose vertices merge into their neighbours, one after another: which vertices are
// joined by an edge, how long their edges are, which triangles they have. What goes on here knows
// no order and no sweeps; see collapse.cpp for these.
//
// All of it goes without branches on what the mesh looks like: processors cannot foresee them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/common/mesh/grid.h"
#include "codec/common/prediction/neighbour_lists.h"

namespace reeb {

/// A set of vertices that is emptied at once.
class MarkedVertices {
 public:
  /// One that stands for none may be the last of `count`: it counts as new, always.
  explicit MarkedVertices(uint32_t count) : stamp_of_(count, 0) {}

  void clear() { ++stamp_; }
  void mark(uint32_t v) { stamp_of_[v] = stamp_; }
  void unmark(uint32_t v) { stamp_of_[v] = 0; }
  bool has(uint32_t v) const { return stamp_of_[v] == stamp_; }
  /// Marks v; false where it was marked.
  bool add(uint32_t v) { return std::exchange(stamp_of_[v], stamp_) != stamp_; }

 private:
  std::vector<uint32_t> stamp_of_;
  uint32_t stamp_ = 0;
};

class CollapsingMesh {
 public:
  /// A vertex of more triangles is left out, triangles and all: with every valence bounded, so is
  /// the time.
  static constexpr uint32_t kMaxFaces = 256;

  /// Vertices are to have room for `growth` neighbours more than at first.
  CollapsingMesh(const GridPoints& points, std::span<const uint32_t> triangles, uint32_t growth);

  /// Stands for no vertex in lists that are filled up to eights; beyond all vertices.
  uint32_t none() const { return none_; }
  /// In no order.
  std::span<const uint32_t> neighbours(uint32_t v) const { return neighbours_[v]; }
  std::span<const uint32_t> neighbours_by_eights(uint32_t v) const {
    return neighbours_.by_eights(v);
  }
  uint32_t valence(uint32_t v) const { return static_cast<uint32_t>(neighbours_[v].size()); }
  uint32_t face_count(uint32_t v) const { return static_cast<uint32_t>(faces_[v].size()); }
  /// In 1/16 of a grid unit: at most 20.8 bits.
  uint32_t mean_edge(uint32_t v) const { return edges_[v] / std::max(1u, valence(v)); }
  /// How many triangles have both.
  uint32_t shared_faces(uint32_t v, uint32_t u) const;

  /// Merges v into `target`, which is one of its neighbours, `near`.
  void merge(uint32_t v, std::span<const uint32_t> near, uint32_t target);

 private:
  using Triangle = std::array<uint32_t, 3>;
  using Indices = std::vector<uint32_t>;

  static uint32_t same(uint32_t a, uint32_t b) { return a == b ? 1 : 0; }
  static bool has(const Triangle& t, uint32_t v) {
    return (same(t[0], v) | same(t[1], v) | same(t[2], v)) != 0;
  }
  void make_lists(uint32_t growth);
  void move_faces(uint32_t v, uint32_t target);

  const GridPoints& points_;
  uint32_t none_;
  std::vector<Triangle> triangles_;
  NeighbourLists neighbours_;
  NeighbourLists faces_;
  Indices edges_;  ///< of every vertex, the lengths of its edges in all: below 2^30
  MarkedVertices marked_;
  Indices moved_, gone_;  ///< triangles, while they move
};

}  // namespace reeb
