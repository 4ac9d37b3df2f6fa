#include "codec/common/attributes/face_corners.h"

#include <algorithm>
#include <utility>

namespace reeb {

namespace {

using Edge = std::pair<uint64_t, uint32_t>;  // lower and higher vertex, corner

std::vector<Edge> sorted_edges(const FaceCorners& corners) {
  std::vector<Edge> edges;
  edges.reserve(corners.count());
  for (uint32_t c = 0; c < corners.count(); ++c) {
    const uint32_t a = corners.vertex[c], b = corners.vertex[corners.next(c)];
    if (a != b) edges.push_back({uint64_t{std::min(a, b)} << 32 | std::max(a, b), c});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

FaceCorners::FaceCorners(const Connectivity& connectivity)
    : vertex(connectivity.corners), first{0}, twin(connectivity.corners.size(), kNoTwin) {
  face.reserve(vertex.size());
  for (uint32_t f = 0; f < connectivity.face_sizes.size(); ++f) {
    first.push_back(first.back() + connectivity.face_sizes[f]);
    face.resize(first.back(), f);
  }
  const std::vector<Edge> edges = sorted_edges(*this);
  for (size_t i = 0; i < edges.size();) {
    size_t end = i + 1;
    while (end < edges.size() && edges[end].first == edges[i].first) ++end;
    const uint32_t a = edges[i].second, b = edges[end - 1].second;
    if (end == i + 2 && vertex[a] != vertex[b]) {
      twin[a] = b;
      twin[b] = a;
    }
    i = end;
  }
}

}  // namespace reeb
