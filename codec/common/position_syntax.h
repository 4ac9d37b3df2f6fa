// Coder of grid positions: each vertex is predicted from those before it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/common/reference_syntax.h"

namespace reeb {

/// Positions of Draco's points.
class PointPositionSyntax {
 public:
  template <class Coder>
  Status code(Coder& coder, MeshState& s) {
    s.point_grid.resize(size_t{s.point_count} * 3);
    std::vector<uint8_t> done(s.point_count, 0);
    std::vector<std::vector<uint32_t>> ring(s.point_count);
    for (uint32_t h = 0; h < s.triangles.size(); ++h) ring[s.triangles[h]].push_back(h);
    for (uint32_t p = 0; p < s.point_count; ++p) {
      int64_t sum[3] = {0, 0, 0};
      int64_t n = 0;
      for (const uint32_t h : ring[p]) {
        const uint32_t e = next_half_edge(h);
        const uint32_t a = s.triangles[e], b = s.triangles[next_half_edge(e)];
        if (!done[a] || !done[b] || s.twins[e] == kNoTwin) continue;
        const uint32_t o = s.triangles[next_half_edge(next_half_edge(s.twins[e]))];
        if (!done[o]) continue;
        for (size_t i = 0; i < 3; ++i)
          sum[i] += s.point_grid[a * 3 + i] + s.point_grid[b * 3 + i] - s.point_grid[o * 3 + i];
        ++n;
      }
      const int kind = n == 0 ? 0 : n == 1 ? 1 : 2;
      if (n == 0) {
        for (const uint32_t h : ring[p]) {
          for (const uint32_t a :
               {s.triangles[next_half_edge(h)], s.triangles[next_half_edge(next_half_edge(h))]}) {
            if (!done[a]) continue;
            for (size_t i = 0; i < 3; ++i) sum[i] += s.point_grid[a * 3 + i];
            ++n;
          }
        }
      }
      if (n == 0 && p > 0) {
        for (size_t i = 0; i < 3; ++i) sum[i] = s.point_grid[size_t{p} * 3 - 3 + i];
        n = 1;
      }
      for (size_t i = 0; i < 3; ++i) {
        const int64_t mean = n == 0 ? 0 : (2 * sum[i] + n) / (2 * n);
        const auto predicted = static_cast<int32_t>(std::clamp<int64_t>(mean, 0, kGridMax));
        int32_t& x = s.point_grid[size_t{p} * 3 + i];
        const int64_t value = int64_t{predicted} + residual_[kind][i].code(coder, x - predicted);
        if (value < 0 || value > kGridMax || ran_dry(coder)) {
          return Status::corrupt("mesh: a position is off the grid");
        }
        x = static_cast<int32_t>(value);
      }
      done[p] = 1;
    }
    return {};
  }

 private:
  SignedModel residual_[3][3];
};

/// Positions of vertices that are in no triangle of Draco's mesh, in the order of coding.
class LoosePositionSyntax {
 public:
  template <class Coder>
  Status code(Coder& coder, uint32_t first, uint32_t vertex_count, std::vector<int32_t>& grid) {
    for (size_t at = size_t{first} * 3; at < size_t{vertex_count} * 3; ++at) {
      int32_t& x = slot(grid, at);
      const int32_t predicted = at < 3 ? 0 : grid[at - 3];
      const int64_t value = int64_t{predicted} + residual_[at % 3].code(coder, x - predicted);
      if (value < 0 || value > kGridMax || ran_dry(coder)) {
        return Status::corrupt("mesh: a position is off the grid");
      }
      x = static_cast<int32_t>(value);
    }
    return {};
  }

 private:
  SignedModel residual_[3];
};

/// The whole section `rest` of a reference mesh.
template <class Coder>
Status code_rest(Coder& coder, MeshState& s, uint64_t max_corners) {
  if (Status status = PointPositionSyntax().code(coder, s); !status.ok()) return status;
  if (Status status = SplitSyntax().code(coder, s); !status.ok()) return status;
  if (Status status = DiagonalSyntax().code(coder, s); !status.ok()) return status;
  const auto highest = std::max_element(s.vertex_of_point.begin(), s.vertex_of_point.end());
  const uint32_t covered = s.point_count == 0 ? 0 : *highest + 1;
  if (s.joined.sizes.size() > s.face_count)
    return Status::corrupt("mesh: more faces than announced");
  const auto listed = static_cast<uint32_t>(s.face_count - s.joined.sizes.size());
  if (Status status = LoosePositionSyntax().code(coder, covered, s.vertex_count, s.grid);
      !status.ok()) {
    return status;
  }
  return FaceListSyntax().code(coder, listed, s.vertex_count, max_corners, s.listed);
}

}  // namespace reeb
