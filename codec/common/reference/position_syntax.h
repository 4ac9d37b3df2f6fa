// Coder of grid positions: each vertex is predicted from those before it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/common/reference/guess_mixture.h"
#include "codec/common/reference/loose_predictor.h"
#include "codec/common/reference/point_predictor.h"
#include "codec/common/reference/reference_syntax.h"

namespace reeb {

/// Codes the positions of points, `topology` being that of their triangles.
template <class Coder>
Status code_point_positions(Coder& coder, const TriangleTopology& topology, MeshState& s) {
  s.point_grid.resize(size_t{s.point_count} * 3);
  PointPredictor predictor(topology);
  GuessMixture guesses(PointPredictor::kKindCount, PointPredictor::kMemory);
  for (const uint32_t p : topology.order) {
    predictor.start(p, s.point_grid);
    for (size_t axis = 0; axis < 3; ++axis) {
      int32_t& x = s.point_grid[size_t{p} * 3 + axis];
      predictor.guess(axis, guesses);
      x = static_cast<int32_t>(guesses.code(coder, static_cast<uint32_t>(x), kGridMax + 1,
                                            predictor.likely(axis), predictor.reach(axis)));
      predictor.learn(axis, x);
    }
    if (ran_dry(coder)) return Status::corrupt("mesh: positions are cut off");
  }
  return {};
}

/// Codes the positions of the vertices from `first` on, which are no point;
/// those before are in `grid` already.
template <class Coder>
Status code_loose_positions(Coder& coder, uint32_t first, uint32_t vertex_count,
                            std::vector<int32_t>& grid) {
  LoosePredictor predictor;
  GuessMixture guesses(LoosePredictor::kKindCount, LoosePredictor::kMemory);
  for (size_t at = size_t{first} * 3; at < size_t{vertex_count} * 3; ++at) {
    int32_t& x = slot(grid, at);
    predictor.guess(at % 3, guesses);
    x = static_cast<int32_t>(guesses.code(coder, static_cast<uint32_t>(x), kGridMax + 1,
                                          predictor.likely(at % 3), predictor.reach(at % 3)));
    predictor.learn(at % 3, x);
    if (ran_dry(coder)) return Status::corrupt("mesh: positions are cut off");
  }
  return {};
}

/// The whole section `rest` of a reference mesh. `topology`: of the edgebreaker's triangles; null
/// for a plain mesh, which has its positions elsewhere: here all are (0, 0, 0).
template <class Coder>
Status code_rest(Coder& coder, const TriangleTopology* topology, MeshState& s,
                 const MostCorners& most) {
  if (topology == nullptr) {
    s.point_grid.assign(size_t{s.point_count} * 3, 0);
  } else if (Status status = code_point_positions(coder, *topology, s); !status.ok()) {
    return status;
  }
  if (Status status = SplitSyntax().code(coder, s); !status.ok()) return status;
  std::span<const uint32_t> twins;
  if (topology != nullptr) twins = topology->twins;
  if (Status status = DiagonalSyntax(twins).code(coder, s); !status.ok()) return status;
  const auto highest = std::max_element(s.vertex_of_point.begin(), s.vertex_of_point.end());
  const uint32_t covered = s.point_count == 0 ? 0 : *highest + 1;
  if (s.joined.sizes.size() > s.face_count)
    return Status::corrupt("mesh: more faces than announced");
  const auto listed = static_cast<uint32_t>(s.face_count - s.joined.sizes.size());
  if (topology == nullptr) {
    s.grid.assign(size_t{s.vertex_count} * 3, 0);
  } else if (Status status = code_loose_positions(coder, covered, s.vertex_count, s.grid);
             !status.ok()) {
    return status;
  }
  return FaceListSyntax().code(coder, listed, s.vertex_count, most, s.listed);
}

}  // namespace reeb
