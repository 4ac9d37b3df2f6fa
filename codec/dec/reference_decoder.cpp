#include "codec/dec/reference_decoder.h"

#include <numeric>

#include "bitstream/bytes.h"
#include "bitstream/headers.h"
#include "bitstream/syntax.h"
#include "codec/common/position_syntax.h"
#include "codec/common/reference_syntax.h"
#include "codec/common/vertex_order.h"
#include "codec/dec/draco_connectivity.h"
#include "entropy/range_coder.h"

namespace reeb {
namespace {

constexpr uint64_t kMaxCornersPerFace = 8;  // on average, of the faces the limits allow

struct Sections {
  std::span<const uint8_t> draco, rest, order;
};

Status read_sections(std::span<const uint8_t> bytes, const Limits& limits, MeshHeader& h,
                     Sections& sections) {
  ByteReader in(bytes);
  if (Status s = read_header(in, "mesh header", h); !s.ok()) return s;
  sections.draco = in.take(h.draco_bytes);
  sections.rest = in.take(h.rest_bytes);
  sections.order = in.take(h.order_bytes);
  if (!in.ok() || in.remaining() != 0) return Status::corrupt("mesh: sections do not fill it");
  if (h.vertex_count > limits.max_vertices) return Status::limit("mesh: too many vertices");
  if (h.face_count > limits.max_faces) return Status::limit("mesh: too many faces");
  return {};
}

Status decode_state(const Sections& sections, const Limits& limits, MeshState& state) {
  if (!sections.draco.empty()) {
    DracoMesh mesh;
    if (Status s = decode_draco_connectivity(sections.draco, limits, mesh); !s.ok()) return s;
    state.point_count = mesh.point_count;
    state.triangles = std::move(mesh.triangles);
    state.twins = pair_half_edges(state.triangles);
  }
  BinaryDecoder coder(sections.rest);
  return code_rest(coder, state, kMaxCornersPerFace * limits.max_faces);
}

void append_triangle(uint32_t a, uint32_t b, uint32_t c, std::vector<uint32_t>& triangles) {
  if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
}

void collect_triangles(const MeshState& state, std::vector<uint32_t>& triangles) {
  const auto& v = state.vertex_of_point;
  for (size_t t = 0; t < state.triangles.size(); t += 3) {
    append_triangle(v[state.triangles[t]], v[state.triangles[t + 1]], v[state.triangles[t + 2]],
                    triangles);
  }
  const uint32_t* corner = state.listed.corners.data();
  for (const uint32_t size : state.listed.sizes) {
    for (uint32_t i = 1; i + 1 < size; ++i) {
      append_triangle(corner[0], corner[i], corner[i + 1], triangles);
    }
    corner += size;
  }
}

void collect_faces(const MeshState& state, const std::vector<uint32_t>& output_index,
                   Connectivity& out) {
  out.vertex_count = state.vertex_count;
  out.face_sizes = state.joined.sizes;
  out.face_sizes.insert(out.face_sizes.end(), state.listed.sizes.begin(), state.listed.sizes.end());
  out.corners.clear();
  for (const uint32_t point : state.joined.corners) {
    out.corners.push_back(output_index[state.vertex_of_point[point]]);
  }
  for (const uint32_t vertex : state.listed.corners) out.corners.push_back(output_index[vertex]);
}

Status decode_order(const MeshHeader& h, std::span<const uint8_t> bytes,
                    std::vector<uint32_t>& output_index) {
  if ((h.flags & MeshHeader::kOrderKept) == 0) {
    if (!bytes.empty()) return Status::corrupt("mesh: an order where none is kept");
    output_index.resize(h.vertex_count);
    std::iota(output_index.begin(), output_index.end(), 0u);
    return {};
  }
  BinaryDecoder coder(bytes);
  return VertexOrderSyntax().code(coder, h.vertex_count, output_index);
}

}  // namespace

Status decode_reference(std::span<const uint8_t> bytes, const Limits& limits, ReferenceMesh& out) {
  out = {};
  MeshHeader h;
  Sections sections;
  if (Status s = read_sections(bytes, limits, h, sections); !s.ok()) return s;
  MeshState state;
  state.vertex_count = h.vertex_count;
  state.face_count = h.face_count;
  if (Status s = decode_state(sections, limits, state); !s.ok()) return s;
  if (Status s = decode_order(h, sections.order, out.output_index); !s.ok()) return s;
  out.vertex_count = h.vertex_count;
  collect_triangles(state, out.triangles);
  collect_faces(state, out.output_index, out.connectivity);
  out.grid = std::move(state.grid);
  return {};
}

}  // namespace reeb
