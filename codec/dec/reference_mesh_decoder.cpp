#include "codec/dec/reference_mesh_decoder.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "bitstream/bytes.h"
#include "bitstream/element_bound.h"
#include "bitstream/headers.h"
#include "bitstream/syntax.h"
#include "codec/common/fast/plain_order.h"
#include "codec/common/fast/plain_positions.h"
#include "codec/common/mesh/mesh_walk.h"
#include "codec/common/reference/face_order.h"
#include "codec/common/reference/position_syntax.h"
#include "codec/common/reference/reference_syntax.h"
#include "codec/common/reference/vertex_order.h"
#include "codec/dec/connectivity/connectivity_decoder.h"
#include "codec/dec/stoppable_decoder.h"

namespace reeb {
namespace {

constexpr uint64_t kMaxCornersPerFace = 8;  // on average, of the faces the limits allow

struct Sections {
  std::span<const uint8_t> draco, rest, positions, order, faces;
};

Status read_sections(std::span<const uint8_t> bytes, const Limits& limits, MeshHeader& h,
                     Sections& sections) {
  ByteReader in(bytes);
  if (Status s = read_header(in, "mesh header", h); !s.ok()) return s;
  sections.draco = in.take(h.draco_bytes);
  sections.rest = in.take(h.rest_bytes);
  sections.positions = in.take(h.position_bytes);
  sections.order = in.take(h.order_bytes);
  sections.faces = in.take(h.face_bytes);
  if (!in.ok() || in.remaining() != 0) return Status::corrupt("mesh: sections do not fill it");
  if (std::max(h.vertex_count, h.face_count) > kMeshElementsPerByte * bytes.size()) {
    return Status::corrupt("mesh: more vertices or faces than its bytes can hold");
  }
  if (h.vertex_count > limits.max_vertices) return Status::limit("mesh: too many vertices");
  if (h.face_count > limits.max_faces) return Status::limit("mesh: too many faces");
  return {};
}

/// `most`: triangles by edgebreaker, and corners of listed faces, that the bytes can hold.
Status decode_state(const Sections& sections, const Limits& limits, uint64_t most, bool plain,
                    const StopToken& stop, MeshState& state,
                    std::optional<TriangleTopology>& topology) {
  if (!sections.draco.empty()) {
    PointTriangles mesh;
    if (Status s = decode_connectivity(sections.draco, limits, most, mesh); !s.ok()) return s;
    state.point_count = mesh.point_count;
    state.triangles = std::move(mesh.triangles);
  }
  if (!plain) topology.emplace(state.point_count, state.triangles);
  StoppableDecoder coder(sections.rest, stop);
  return code_rest(coder, plain ? nullptr : &*topology, state,
                   {kMaxCornersPerFace * limits.max_faces, most});
}

Status decode_plain_positions(std::span<const uint8_t> bytes, const MeshWalk& walk,
                              std::vector<int32_t>& grid) {
  RansDecoder decoder;
  if (!decoder.open(bytes, 3) || !code_plain_positions(decoder, walk, grid) || decoder.overrun())
    return Status::corrupt("mesh: positions are damaged");
  return {};
}

Status decode_plain_order(std::span<const uint8_t> bytes, const MeshWalk& walk,
                          std::vector<uint32_t>& output_index) {
  RansDecoder decoder;
  if (!decoder.open(bytes, 1) || !code_plain_order(decoder, walk, output_index) ||
      decoder.overrun())
    return Status::corrupt("mesh: the order is damaged");
  return {};
}

/// Positions and order of a plain mesh.
Status decode_plain(const MeshHeader& h, const Sections& sections,
                    std::span<const uint32_t> triangles, const StopToken& stop,
                    std::vector<int32_t>& grid, std::vector<uint32_t>& output_index) {
  const MeshWalk walk = walk_mesh(h.vertex_count, triangles);
  stop.check();
  if (Status s = decode_plain_positions(sections.positions, walk, grid); !s.ok()) return s;
  stop.check();
  if ((h.flags & MeshHeader::kOrderKept) == 0) return {};
  output_index.assign(h.vertex_count, 0);
  return decode_plain_order(sections.order, walk, output_index);
}

/// `topology`: of the edgebreaker's triangles and points, which mostly are all triangles and all
/// vertices. Leaves the order of a plain mesh, which is there already.
Status decode_order(const MeshHeader& h, std::span<const uint8_t> bytes,
                    std::span<const uint32_t> triangles, const StopToken& stop,
                    std::optional<TriangleTopology>& topology,
                    std::vector<uint32_t>& output_index) {
  if ((h.flags & MeshHeader::kOrderKept) == 0) {
    if (!bytes.empty()) return Status::corrupt("mesh: an order where none is kept");
    output_index.resize(h.vertex_count);
    std::iota(output_index.begin(), output_index.end(), 0u);
    return {};
  }
  if ((h.flags & MeshHeader::kPlain) != 0) return {};
  const bool same = topology->point_count() == h.vertex_count &&
                    std::equal(triangles.begin(), triangles.end(), topology->triangles.begin(),
                               topology->triangles.end());
  if (!same) topology.emplace(h.vertex_count, triangles);
  StoppableDecoder coder(bytes, stop);
  return code_vertex_order(coder, *topology, output_index);
}

/// Puts the faces into the order of the input, where the stream keeps it.
Status decode_face_order(const MeshHeader& h, std::span<const uint8_t> bytes, const StopToken& stop,
                         Connectivity& faces) {
  if ((h.flags & MeshHeader::kFaceOrderKept) == 0) return {};
  StoppableDecoder coder(bytes, stop);
  const FaceOrderContext context(faces);
  FaceOrder order;
  if (Status s = code_face_order(coder, context, order); !s.ok()) return s;
  faces = arrange_faces(context, order, h.vertex_count);
  return {};
}

}  // namespace

uint64_t announced_triangles(std::span<const uint8_t> bytes) {
  ByteReader in(bytes);
  MeshHeader h;
  if (!read_header(in, "mesh header", h).ok()) return 0;
  return connectivity_triangle_count(in.take(h.draco_bytes));
}

Status decode_reference(std::span<const uint8_t> bytes, const Limits& limits, ReferenceMesh& out,
                        const StopToken& stop) {
  out = {};
  MeshHeader h;
  Sections sections;
  if (Status s = read_sections(bytes, limits, h, sections); !s.ok()) return s;
  MeshState state;
  state.vertex_count = h.vertex_count;
  state.face_count = h.face_count;
  out.plain = (h.flags & MeshHeader::kPlain) != 0;
  const uint64_t most = kMeshElementsPerByte * bytes.size();
  std::optional<TriangleTopology> topology;
  if (Status s = decode_state(sections, limits, most, out.plain, stop, state, topology); !s.ok())
    return s;
  out.vertex_count = h.vertex_count;
  out.triangles = collect_triangles(state);
  if (out.plain) {
    Status s = decode_plain(h, sections, out.triangles, stop, state.grid, out.output_index);
    if (!s.ok()) return s;
  }
  if (Status s = decode_order(h, sections.order, out.triangles, stop, topology, out.output_index);
      !s.ok())
    return s;
  out.connectivity = collect_faces(state, out.output_index);
  out.grid = std::move(state.grid);
  return decode_face_order(h, sections.faces, stop, out.connectivity);
}

}  // namespace reeb
