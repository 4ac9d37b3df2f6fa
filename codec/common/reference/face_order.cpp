#include "codec/common/reference/face_order.h"

#include <algorithm>
#include <utility>

namespace reeb {

FaceOrderContext::FaceOrderContext(const Connectivity& faces) : faces_(faces) {
  first_.reserve(faces.face_sizes.size() + 1);
  first_.push_back(0);
  for (const uint32_t size : faces.face_sizes) first_.push_back(first_.back() + size);
}

std::vector<uint32_t> FaceOrderContext::faces_across() const {
  std::vector<std::pair<uint64_t, uint32_t>> edges;  // lower and higher vertex, corner
  edges.reserve(faces_.corners.size());
  std::vector<uint32_t> across(faces_.corners.size());
  for (uint32_t f = 0; f < count(); ++f) {
    const auto c = corners(f);
    for (size_t i = 0; i < c.size(); ++i) {
      const uint32_t next = c[i + 1 < c.size() ? i + 1 : 0];
      const uint64_t ends = uint64_t{std::min(c[i], next)} << 32 | std::max(c[i], next);
      edges.emplace_back(ends, static_cast<uint32_t>(first_[f] + i));
      across[first_[f] + i] = f;
    }
  }
  std::sort(edges.begin(), edges.end());
  for (size_t i = 0; i < edges.size();) {
    size_t end = i + 1;
    while (end < edges.size() && edges[end].first == edges[i].first) ++end;
    if (end == i + 2) std::swap(across[edges[i].second], across[edges[i + 1].second]);
    i = end;
  }
  return across;
}

std::vector<uint32_t> FaceOrderContext::dual_triangles() const {
  const std::vector<uint32_t> across = faces_across();
  std::vector<uint32_t> out;
  std::vector<uint32_t> around;
  for (uint32_t f = 0; f < count(); ++f) {
    around.clear();
    for (size_t i = first_[f]; i < first_[f + 1]; ++i) {
      if (across[i] != f) around.push_back(across[i]);
    }
    for (size_t i = 0; i < around.size(); ++i) {
      const uint32_t next = around[i + 1 < around.size() ? i + 1 : 0];
      if (around[i] != next) out.insert(out.end(), {f, around[i], next});
    }
  }
  return out;
}

uint32_t FaceOrderContext::index_by_vertex(uint32_t face) const {
  const auto c = corners(face);
  const uint64_t lowest = *std::min_element(c.begin(), c.end());
  return static_cast<uint32_t>(lowest * count() / faces_.vertex_count);
}

Connectivity arrange_faces(const FaceOrderContext& context, const FaceOrder& order,
                           uint32_t vertex_count) {
  std::vector<uint32_t> face_at(context.count());
  for (uint32_t f = 0; f < context.count(); ++f) face_at[order.index[f]] = f;
  Connectivity out;
  out.vertex_count = vertex_count;
  out.face_sizes.reserve(face_at.size());
  for (const uint32_t f : face_at) {
    const auto c = context.corners(f);
    const auto first = c.begin() + order.first[f];
    out.face_sizes.push_back(static_cast<uint32_t>(c.size()));
    out.corners.insert(out.corners.end(), first, c.end());
    out.corners.insert(out.corners.end(), c.begin(), first);
  }
  return out;
}

}  // namespace reeb
