#include "codec/dec/attributes/render_mesh.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace reeb {

namespace {

/// Compares what two corners have, key after key.
int compare_keys(std::span<const CornerKeys> split_by, uint32_t a, uint32_t b) {
  for (const auto& [keys, bytes] : split_by) {
    const int order = std::memcmp(keys + a * bytes, keys + b * bytes, bytes);
    if (order != 0) return order;
  }
  return 0;
}

/// Of every corner, the lowest one with its vertex and keys.
std::vector<uint32_t> lowest_alike(const Connectivity& c, std::span<const CornerKeys> split_by) {
  std::vector<uint32_t> order(c.corners.size()), lowest(c.corners.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto compare = [&](uint32_t a, uint32_t b) {
    if (c.corners[a] != c.corners[b]) return c.corners[a] < c.corners[b] ? -1 : 1;
    return compare_keys(split_by, a, b);
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const int before = compare(a, b);
    return before != 0 ? before < 0 : a < b;
  });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && compare(order[i - 1], order[i]) == 0;
    lowest[order[i]] = same ? lowest[order[i - 1]] : order[i];
  }
  return lowest;
}

int64_t material_of(const Attribute& a, uint32_t face) {
  if (a.type == ValueType::kI32) return a.get<int32_t>(face);
  return size_of(a.type) == 2 ? int64_t{a.get<uint16_t>(face)} : int64_t{a.get<uint8_t>(face)};
}

/// Faces by material, those of one in their order.
std::vector<uint32_t> by_material(const Connectivity& c, const Attribute* material) {
  std::vector<uint32_t> faces(c.face_sizes.size());
  std::iota(faces.begin(), faces.end(), 0u);
  if (material == nullptr) return faces;
  std::stable_sort(faces.begin(), faces.end(), [&](uint32_t a, uint32_t b) {
    return material_of(*material, a) < material_of(*material, b);
  });
  return faces;
}

}  // namespace

RenderMesh make_render_mesh(const Connectivity& c, std::span<const CornerKeys> split_by,
                            const Attribute* material) {
  RenderMesh out;
  out.shot_vertices = c.vertex_count;
  const std::vector<uint32_t> lowest = lowest_alike(c, split_by);
  std::vector<uint32_t> vertex(c.corners.size());  // render vertex of each corner
  for (uint32_t i = 0; i < lowest.size(); ++i) {
    if (lowest[i] == i) {
      vertex[i] = out.vertex_count();
      out.source_vertex.push_back(c.corners[i]);
      out.source_corner.push_back(i);
    } else {
      vertex[i] = vertex[lowest[i]];
    }
  }
  std::vector<uint32_t> first(c.face_sizes.size() + 1);
  std::partial_sum(c.face_sizes.begin(), c.face_sizes.end(), first.begin() + 1);
  for (const uint32_t face : by_material(c, material)) {
    const int64_t value = material == nullptr ? 0 : material_of(*material, face);
    for (uint32_t i = first[face] + 1; i + 1 < first[face + 1]; ++i) {
      if (out.ranges.empty() || out.ranges.back().material != value)
        out.ranges.push_back({value, static_cast<uint32_t>(out.source_face.size()), 0});
      ++out.ranges.back().count;
      out.triangles.insert(out.triangles.end(), {vertex[first[face]], vertex[i], vertex[i + 1]});
      out.source_face.push_back(face);
    }
  }
  return out;
}

uint64_t render_mesh_memory(const Connectivity& c) {
  constexpr uint64_t kPerCorner = 3 * 4 + 2 * (4 + 4) + 2 * (3 * 4 + 4);  // lists grow by doubling
  constexpr uint64_t kPerFace = 2 * 4 + 2 * sizeof(RenderMesh::Range);
  return c.corners.size() * kPerCorner + c.face_sizes.size() * kPerFace;
}

uint64_t kept_memory(const RenderMesh& m) {
  const uint64_t numbers = m.source_vertex.capacity() + m.source_corner.capacity() +
                           m.triangles.capacity() + m.source_face.capacity();
  return numbers * sizeof(uint32_t) + m.ranges.capacity() * sizeof(RenderMesh::Range);
}

}  // namespace reeb
