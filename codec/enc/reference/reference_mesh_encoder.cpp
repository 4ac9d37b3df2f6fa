#include "codec/enc/reference/reference_mesh_encoder.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <set>

#include "bitstream/element_bound.h"
#include "bitstream/headers.h"
#include "bitstream/syntax.h"
#include "codec/common/fast/plain_order.h"
#include "codec/common/fast/plain_positions.h"
#include "codec/common/mesh/connectivity.h"
#include "codec/common/mesh/faces.h"
#include "codec/common/mesh/mesh_walk.h"
#include "codec/common/reference/face_order.h"
#include "codec/common/reference/position_syntax.h"
#include "codec/common/reference/reference_syntax.h"
#include "codec/common/reference/vertex_order.h"
#include "codec/dec/reference_mesh_decoder.h"
#include "codec/enc/reference/draco_connectivity_encoder.h"
#include "codec/enc/reference/face_matching.h"
#include "codec/enc/reference/face_set.h"
#include "entropy/interval_coder.h"

namespace reeb {

// What the encoder decides before anything is coded: which faces go to Draco and what it makes of
// them.
struct DracoPlan {
  std::vector<uint32_t> faces;  // input faces in Draco's mesh
  DracoEncoding encoding;       // empty where no face is
  std::vector<uint32_t> twins;
  std::vector<uint8_t> diagonal;
};

namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr uint32_t kMaxCount = 1u << 30;  // of vertices and of corners; differences fit 32 bits

Status check_input(const Connectivity& c, std::span<const int32_t> grid) {
  const uint64_t corners = std::accumulate(c.face_sizes.begin(), c.face_sizes.end(), uint64_t{0});
  if (c.vertex_count == 0 || c.vertex_count > kMaxCount ||
      grid.size() != size_t{c.vertex_count} * 3) {
    return Status::invalid("reference mesh: vertices and positions do not match");
  }
  if (corners != c.corners.size() || std::count(c.face_sizes.begin(), c.face_sizes.end(), 0u) > 0 ||
      corners > kMaxCount) {
    return Status::invalid("reference mesh: face sizes and corners do not match");
  }
  const auto beyond = [&](uint32_t v) { return v >= c.vertex_count; };
  if (std::any_of(c.corners.begin(), c.corners.end(), beyond)) {
    return Status::invalid("reference mesh: a face has a vertex that is not there");
  }
  const auto off_grid = [](int32_t x) { return x < 0 || x > kGridMax; };
  if (std::any_of(grid.begin(), grid.end(), off_grid)) {
    return Status::invalid("reference mesh: a position is off the grid");
  }
  return {};
}

class Planner {
 public:
  explicit Planner(const Connectivity& input) : faces_(input) {}

  // Hands faces to Draco and takes those back that it does not reproduce, until all others survive.
  DracoPlan plan() {
    DracoPlan plan;
    plan.faces = faces_.regular();
    constexpr int kTrials = 6;
    for (int trial = 0; trial < kTrials && !plan.faces.empty(); ++trial) {
      if (!encode(plan)) break;
      const std::vector<uint32_t> lost = find_lost(plan);
      if (lost.empty()) return plan;
      std::vector<uint32_t> rest;
      std::set_difference(plan.faces.begin(), plan.faces.end(), lost.begin(), lost.end(),
                          std::back_inserter(rest));
      plan.faces = std::move(rest);
    }
    return {};
  }

 private:
  // Fans of the faces over the vertices they use, renumbered without gaps.
  bool encode(DracoPlan& plan) {
    std::vector<uint32_t> triangles, vertices;
    for (const uint32_t f : plan.faces) {
      const auto corners = faces_.corners(f);
      for (size_t i = 1; i + 1 < corners.size(); ++i) {
        triangles.insert(triangles.end(), {corners[0], corners[i], corners[i + 1]});
      }
      vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (uint32_t& v : triangles) {
      v = static_cast<uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) -
                                vertices.begin());
    }
    plan.encoding = {};
    if (!encode_draco_connectivity(triangles, static_cast<uint32_t>(vertices.size()),
                                   plan.encoding)) {
      return false;
    }
    for (uint32_t& v : plan.encoding.vertex_of) {
      if (v >= vertices.size()) return false;
      v = vertices[v];
    }
    return true;
  }

  // Marks the diagonals of the polygons and returns the faces (sorted) that would not come back.
  std::vector<uint32_t> find_lost(DracoPlan& plan) {
    const PointTriangles& mesh = plan.encoding.mesh;
    plan.twins = pair_half_edges(mesh.triangles);
    const std::vector<uint32_t> owner = faces_.owners(plan.faces, mesh, plan.encoding.vertex_of);
    plan.diagonal.assign(mesh.triangles.size(), 0);
    for (uint32_t h = 0; h < mesh.triangles.size(); ++h) {
      const uint32_t twin = plan.twins[h];
      if (twin == kNoTwin || owner[h / 3] == kNone || owner[h / 3] != owner[twin / 3]) continue;
      plan.diagonal[h] = 1;
    }
    Polygons joined;
    if (!join_triangles(mesh.triangles, plan.twins, plan.diagonal, joined)) return plan.faces;
    for (uint32_t& point : joined.corners) point = plan.encoding.vertex_of[point];
    return faces_.missing(plan.faces, joined);
  }

  FaceSet faces_;
};

// Numbers the vertices: those of points as they come, then the others as in the input.
std::vector<uint32_t> inverse(const std::vector<uint32_t>& order) {
  std::vector<uint32_t> out(order.size());
  for (uint32_t v = 0; v < order.size(); ++v) out[order[v]] = v;
  return out;
}

std::vector<uint32_t> number_vertices(const Connectivity& input, const DracoEncoding& encoding) {
  std::vector<uint32_t> coding(input.vertex_count, kNone);
  uint32_t next = 0;
  for (const uint32_t v : encoding.vertex_of) {
    if (coding[v] == kNone) coding[v] = next++;
  }
  for (uint32_t& c : coding) {
    if (c == kNone) c = next++;
  }
  return coding;
}

void list_other_faces(const Connectivity& input, const std::vector<uint32_t>& in_draco,
                      const std::vector<uint32_t>& coding, Polygons& listed) {
  size_t corner = 0;
  auto skip = in_draco.begin();
  for (uint32_t f = 0; f < input.face_sizes.size(); corner += input.face_sizes[f++]) {
    if (skip != in_draco.end() && *skip == f) {
      ++skip;
      continue;
    }
    listed.sizes.push_back(input.face_sizes[f]);
    for (uint32_t i = 0; i < input.face_sizes[f]; ++i) {
      listed.corners.push_back(coding[input.corners[corner + i]]);
    }
  }
}

MeshState make_state(const Connectivity& input, std::span<const int32_t> grid,
                     const DracoPlan& plan, const std::vector<uint32_t>& coding) {
  MeshState s;
  s.vertex_count = input.vertex_count;
  s.face_count = static_cast<uint32_t>(input.face_sizes.size());
  s.point_count = plan.encoding.mesh.point_count;
  s.triangles = plan.encoding.mesh.triangles;
  s.diagonal = plan.diagonal;
  for (const uint32_t v : plan.encoding.vertex_of) {
    s.vertex_of_point.push_back(coding[v]);
    s.point_grid.insert(s.point_grid.end(), &grid[size_t{v} * 3], &grid[size_t{v} * 3] + 3);
  }
  s.grid.resize(grid.size());
  for (size_t v = 0; v < coding.size(); ++v) {
    std::copy_n(&grid[v * 3], 3, &s.grid[size_t{coding[v]} * 3]);
  }
  list_other_faces(input, plan.faces, coding, s.listed);
  return s;
}

std::vector<uint8_t> write_plain_positions(const MeshState& state, const MeshWalk& walk) {
  RansEncoder coder(3);
  std::vector<int32_t> grid = state.grid;
  code_plain_positions(coder, walk, grid);
  return coder.finish();
}

Status write_order(const MeshState& state, const std::vector<uint32_t>& coding,
                   const MeshWalk* walk, std::vector<uint8_t>& bytes) {
  std::vector<uint32_t> output_index(coding.size());
  for (uint32_t v = 0; v < coding.size(); ++v) output_index[coding[v]] = v;
  if (walk != nullptr) {
    RansEncoder coder(1);
    code_plain_order(coder, *walk, output_index);
    bytes = coder.finish();
    return {};
  }
  IntervalEncoder coder;
  const std::vector<uint32_t> triangles = collect_triangles(state);
  Status status =
      code_vertex_order(coder, TriangleTopology(state.vertex_count, triangles), output_index);
  bytes = coder.finish();
  return status;
}

Status write_face_order(const Connectivity& input, const MeshState& state,
                        const std::vector<uint32_t>& coding, std::vector<uint8_t>& bytes) {
  const Connectivity faces = collect_faces(state, inverse(coding));
  FaceOrder order = match_faces(faces, input);
  IntervalEncoder coder;
  Status status = code_face_order(coder, FaceOrderContext(faces), order);
  bytes = coder.finish();
  return status;
}

/// How many bytes a mesh must have. Zeros at the end of a range code mean nothing; they keep
/// extreme meshes within the bound.
size_t least_bytes(const MeshState& s) {
  const size_t elements = std::max({size_t{s.vertex_count}, size_t{s.face_count},
                                    s.triangles.size() / 3, s.listed.corners.size()});
  return (elements + kMeshElementsPerByte - 1) / kMeshElementsPerByte;
}

Status write_mesh(const Connectivity& input, const DracoPlan& plan,
                  const std::vector<uint32_t>& coding, const ReferenceOptions& options,
                  MeshState& state, std::vector<uint8_t>& bytes) {
  IntervalEncoder coder;
  std::vector<uint8_t> positions;
  MeshWalk walk;
  if (options.plain) {
    walk = walk_mesh(state.vertex_count, collect_triangles(state));
    positions = write_plain_positions(state, walk);
  }
  std::optional<TriangleTopology> topology;
  if (!options.plain) topology.emplace(state.point_count, state.triangles);
  if (Status s = code_rest(coder, topology ? &*topology : nullptr, state, {}); !s.ok()) return s;
  std::vector<uint8_t> rest = coder.finish();
  std::vector<uint8_t> order;
  if (!options.reorder) {
    if (Status s = write_order(state, coding, options.plain ? &walk : nullptr, order); !s.ok())
      return s;
  }
  const bool keeps_faces = options.face_order && !options.reorder;
  std::vector<uint8_t> faces;
  if (keeps_faces) {
    if (Status s = write_face_order(input, state, coding, faces); !s.ok()) return s;
  }
  const size_t others =
      plan.encoding.section.size() + positions.size() + order.size() + faces.size();
  rest.resize(std::max(rest.size(), least_bytes(state) - std::min(others, least_bytes(state))));
  const auto flags = static_cast<uint8_t>((options.reorder ? 0 : MeshHeader::kOrderKept) |
                                          (keeps_faces ? MeshHeader::kFaceOrderKept : 0) |
                                          (options.plain ? MeshHeader::kPlain : 0));
  const MeshHeader header = {
      state.vertex_count, state.face_count, flags,        plan.encoding.section.size(),
      rest.size(),        positions.size(), order.size(), faces.size()};
  if (Status s = write_header(header, "mesh header", bytes); !s.ok()) return s;
  const std::vector<uint8_t>* const parts[] = {&plan.encoding.section, &rest, &positions, &order,
                                               &faces};
  for (const auto* part : parts) bytes.insert(bytes.end(), part->begin(), part->end());
  return {};
}

// Positions and faces of `decoded` are those of the input, vertices renamed by `coding` where the
// order is dropped.
bool survives(const Connectivity& input, std::span<const int32_t> grid,
              const std::vector<uint32_t>& coding, const ReferenceOptions& options,
              const ReferenceMesh& decoded) {
  const bool reorder = options.reorder;
  Connectivity expected = input;
  for (uint32_t v = 0; v < coding.size(); ++v) {
    if (decoded.output_index[coding[v]] != (reorder ? coding[v] : v)) return false;
    if (!std::equal(&grid[size_t{v} * 3], &grid[size_t{v} * 3] + 3,
                    &decoded.grid[size_t{coding[v]} * 3])) {
      return false;
    }
  }
  if (reorder) {
    for (uint32_t& v : expected.corners) v = coding[v];
  }
  if (options.face_order && !reorder) return expected == decoded.connectivity;
  return same_faces(expected, decoded.connectivity);
}

}  // namespace

ReferencePlan::ReferencePlan(const Connectivity& connectivity) : connectivity_(connectivity) {}
ReferencePlan::~ReferencePlan() = default;

const DracoPlan& ReferencePlan::draco() {
  if (draco_ == nullptr) draco_ = std::make_unique<DracoPlan>(Planner(connectivity_).plan());
  return *draco_;
}

std::vector<uint32_t> ReferencePlan::input_vertices() {
  return inverse(number_vertices(connectivity_, draco().encoding));
}

Status encode_reference(const Connectivity& connectivity, std::span<const int32_t> grid,
                        const ReferenceOptions& options, std::vector<uint8_t>& bytes,
                        ReferenceMesh& decoded, std::vector<uint32_t>& input_index) {
  ReferencePlan plan(connectivity);
  return encode_reference(plan, grid, options, bytes, decoded, input_index);
}

Status encode_reference(ReferencePlan& reusable, std::span<const int32_t> grid,
                        const ReferenceOptions& options, std::vector<uint8_t>& bytes,
                        ReferenceMesh& decoded, std::vector<uint32_t>& input_index) {
  bytes.clear();
  const Connectivity& connectivity = reusable.connectivity();
  if (Status s = check_input(connectivity, grid); !s.ok()) return s;
  const DracoPlan& plan = reusable.draco();
  const std::vector<uint32_t> coding = number_vertices(connectivity, plan.encoding);
  MeshState state = make_state(connectivity, grid, plan, coding);

  if (Status s = write_mesh(connectivity, plan, coding, options, state, bytes); !s.ok()) return s;
  constexpr uint32_t kAny = std::numeric_limits<uint32_t>::max();
  const Limits limits = {kAny, kAny, kAny, std::numeric_limits<uint64_t>::max()};
  if (Status s = decode_reference(bytes, limits, decoded); !s.ok()) return s;
  if (!survives(connectivity, grid, coding, options, decoded)) {
    return Status::invalid("reference mesh: it does not survive its coding");
  }
  input_index = inverse(coding);
  return {};
}

}  // namespace reeb
