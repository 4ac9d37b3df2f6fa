// The half-edges around each vertex of a triangle list.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace reeb {

class HalfEdgeFans {
 public:
  /// `triangles`: three vertices below `vertex_count` each.
  HalfEdgeFans(uint32_t vertex_count, std::span<const uint32_t> triangles)
      : first_(size_t{vertex_count} + 1), half_edges_(triangles.size()) {
    for (const uint32_t v : triangles) ++first_[size_t{v} + 1];
    for (size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
    std::vector<uint32_t> at(first_.begin(), first_.end() - 1);
    for (uint32_t h = 0; h < triangles.size(); ++h) half_edges_[at[triangles[h]]++] = h;
  }

  uint32_t vertex_count() const { return static_cast<uint32_t>(first_.size() - 1); }
  /// Half-edges that start at v, ascending.
  std::span<const uint32_t> operator[](uint32_t v) const {
    return std::span(half_edges_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

 private:
  std::vector<uint32_t> first_;
  std::vector<uint32_t> half_edges_;
};

}  // namespace reeb
