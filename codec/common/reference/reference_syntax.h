// Syntax of what an edgebreaker does not carry of a reference mesh, one function per part for both
// directions: with an encoder the state is complete and is read, with a decoder it grows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/mesh/connectivity.h"
#include "codec/common/mesh/shared_places.h"
#include "codec/common/reference/mesh_state.h"
#include "codec/common/reference/reference_mesh.h"
#include "entropy/adaptive_bit.h"
#include "entropy/integer_coder.h"

namespace reeb {

/// Which points are the same vertex: only points at the same place can be.
class SplitSyntax {
 public:
  /// Codes `vertex_of_point`; appends the grid positions of new vertices when decoding.
  template <class Coder>
  Status code(Coder& coder, MeshState& s) {
    uint32_t vertices = 0;
    const NumberedPlaces places = number_places(s.point_grid);
    at_place_.resize(places.count);
    std::vector<uint32_t> none;
    for (uint32_t p = 0; p < s.point_count; ++p) {
      none.clear();
      const uint32_t place = places.of_point[p];
      std::vector<uint32_t>& here = place == NumberedPlaces::kNone ? none : at_place_[place];
      uint32_t& vertex = slot(s.vertex_of_point, p);
      if (!here.empty() &&
          same_[std::min<size_t>(here.size(), 2) - 1].code(coder, vertex < vertices)) {
        uint32_t back = 0;
        if constexpr (!kDecodes<Coder>) {
          // Vertices rise; one that is new is not there, and not asked for.
          back = static_cast<uint32_t>(here.end() -
                                       std::lower_bound(here.begin(), here.end(), vertex)) -
                 1;
        }
        back = which_.code(coder, back);
        if (back >= here.size()) return Status::corrupt("mesh: a split point joins no vertex");
        vertex = here[here.size() - 1 - back];
        continue;
      }
      if (vertices == s.vertex_count || ran_dry(coder)) {
        return Status::corrupt("mesh: more points than vertices");
      }
      for (size_t i = 0; i < 3; ++i)
        slot(s.grid, size_t{vertices} * 3 + i) = s.point_grid[size_t{p} * 3 + i];
      here.push_back(vertices);
      vertex = vertices++;
    }
    return {};
  }

 private:
  std::vector<std::vector<uint32_t>> at_place_;  ///< vertices at each, oldest first
  AdaptiveBit same_[2];
  ExpGolombModel which_;
};

/// Which edges between triangles are inside a polygon.
class DiagonalSyntax {
 public:
  /// `twins` of the mesh's triangles, see pair_half_edges; empty where they are not known yet.
  explicit DiagonalSyntax(std::span<const uint32_t> twins) : twins_(twins) {}

  template <class Coder>
  Status code(Coder& coder, MeshState& s) {
    const bool any = coder.code(
        std::find(s.diagonal.begin(), s.diagonal.end(), 1) != s.diagonal.end(), kEvenOdds);
    s.diagonal.resize(s.triangles.size(), 0);
    if (!any) {
      s.joined.sizes.assign(s.triangles.size() / 3, 3);
      s.joined.corners = s.triangles;
      return {};
    }
    if (twins_.empty()) {
      own_twins_ = pair_half_edges(s.triangles);
      twins_ = own_twins_;
    }
    known_.resize(s.triangles.size() / 3);
    for (uint32_t h = 0; h < s.triangles.size(); ++h) {
      const uint32_t twin = twins_[h];
      if (twin == kNoTwin) {
        ++known_[h / 3].decided;
      } else if (twin > h) {
        code_edge(coder, s, h, twin);
        if (ran_dry(coder)) return Status::corrupt("mesh: polygons are cut off");
      }
    }
    return join_triangles(s.triangles, twins_, s.diagonal, s.joined)
               ? Status()
               : Status::corrupt("mesh: polygons overlap themselves");
  }

 private:
  struct Known {
    uint8_t decided = 0, marked = 0;  // edges of the triangle, and those inside a polygon
  };

  template <class Coder>
  void code_edge(Coder& coder, MeshState& s, uint32_t h, uint32_t twin) {
    Known& a = known_[h / 3];
    Known& b = known_[twin / 3];
    AdaptiveBit& model = models_[state(a) * 9 + state(b)][longest(s, h) + longest(s, twin)];
    const bool inside = model.code(coder, s.diagonal[h] != 0);
    s.diagonal[h] = s.diagonal[twin] = inside ? 1 : 0;
    for (Known* k : {&a, &b}) {
      ++k->decided;
      k->marked = static_cast<uint8_t>(k->marked + (inside ? 1 : 0));
    }
  }

  static uint32_t state(const Known& k) {
    return std::min<uint32_t>(k.decided, 2) * 3 + std::min<uint32_t>(k.marked, 2);
  }

  // 1 where half-edge h is the longest side of its triangle: mostly so for a quadrilateral's
  // diagonal.
  static uint32_t longest(const MeshState& s, uint32_t h) {
    const uint64_t own = length2(s, h);
    const uint32_t next = next_half_edge(h);
    return own >= length2(s, next) && own >= length2(s, next_half_edge(next)) ? 1 : 0;
  }

  static uint64_t length2(const MeshState& s, uint32_t h) {
    const int32_t* a = &s.point_grid[size_t{s.triangles[h]} * 3];
    const int32_t* b = &s.point_grid[size_t{s.triangles[next_half_edge(h)]} * 3];
    uint64_t sum = 0;
    for (int i = 0; i < 3; ++i) {
      const int64_t d = int64_t{a[i]} - b[i];
      sum += static_cast<uint64_t>(d * d);
    }
    return sum;
  }

  std::span<const uint32_t> twins_;
  std::vector<uint32_t> own_twins_;
  std::vector<Known> known_;
  AdaptiveBit models_[81][3];
};

/// How many corners the listed faces may have: more than `by_limits` exceed a limit, more than
/// `by_bytes` are corrupt.
struct MostCorners {
  uint64_t by_limits = UINT64_MAX;
  uint64_t by_bytes = UINT64_MAX;
};

/// Faces that are not among its triangles, corner by corner.
class FaceListSyntax {
 public:
  /// Codes `count` faces over `vertex_count` vertices with at most `most` corners in all.
  template <class Coder>
  Status code(Coder& coder, uint32_t count, uint32_t vertex_count, const MostCorners& most,
              Polygons& faces) {
    uint32_t last = 0;
    size_t corner = 0;
    for (uint32_t f = 0; f < count; ++f) {
      uint32_t& size = slot(faces.sizes, f);
      size = size_.code(coder, size - 1) + 1;
      if (size > most.by_limits - corner) return Status::limit("mesh: too many face corners");
      if (size > most.by_bytes - corner)
        return Status::corrupt("mesh: more face corners than its bytes can hold");
      for (uint32_t i = 0; i < size; ++i, ++corner) {
        uint32_t& v = slot(faces.corners, corner);
        const int64_t value = int64_t{last} + step_.code(coder, static_cast<int32_t>(v - last));
        if (value < 0 || value >= vertex_count || ran_dry(coder)) {
          return Status::corrupt("mesh: a listed face has no such vertex");
        }
        v = last = static_cast<uint32_t>(value);
      }
    }
    return {};
  }

 private:
  ExpGolombModel size_;
  SignedModel step_;
};

}  // namespace reeb
