#include "conformance/generate/shot_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "bitstream/bytes.h"
#include "bitstream/chunk.h"
#include "bitstream/element_bound.h"
#include "bitstream/syntax.h"
#include "codec/common/fast/lane_field.h"
#include "codec/common/motion/motion_syntax.h"
#include "codec/common/reference/position_syntax.h"
#include "codec/common/reference/reference_syntax.h"
#include "codec/common/reference/vertex_order.h"
#include "codec/common/synthesis/correction_field.h"
#include "codec/dec/reference_mesh_decoder.h"
#include "entropy/range_coder.h"

namespace reeb::conformance {
namespace {

void require(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "%s\n", status.message().c_str());
  std::exit(1);
}

BuiltMesh finish_mesh(Bytes bytes) {
  ReferenceMesh mesh;
  require(decode_reference(bytes, {}, mesh));
  return {std::move(bytes), Surface(mesh)};
}

void code_components(Field& field, BinaryEncoder& coder, uint32_t count,
                     const Residuals& residuals) {
  for (uint32_t k = 0; k < count; ++k) {
    field.code_component([&](uint32_t row, float, uint32_t, MagnitudeModel::Bins& bins) {
      const int64_t wanted = residuals(k, row);
      const auto size = static_cast<int64_t>(
          MagnitudeModel::representable(static_cast<uint64_t>(std::abs(wanted))));
      return field.model().code(coder, bins, wanted < 0 ? -size : size);
    });
  }
}

Bytes code_lanes(LaneField field, uint32_t count, const Residuals& residuals) {
  RansEncoder coder(std::min(kRansLanes, count));
  LaneField::Planes planes;
  for (uint32_t k = 0, lanes = 0; k < count; k += lanes) {
    lanes = lanes_of_block(k, count);
    field.begin_block();
    for (uint32_t row = 0; row < field.rows(); ++row) {
      const LaneGuess guess = field.guess(row);
      int32_t n[kRansLanes] = {};
      for (uint32_t l = 0; l < lanes; ++l) {
        constexpr int64_t kMax = kRansMaxMagnitude;
        n[l] = static_cast<int32_t>(std::clamp(residuals(k + l, row), -kMax, kMax));
        coder.put(l, guess.cls[l], n[l]);
      }
      field.note(row, guess, n);
    }
    field.end_block(lanes, planes);
  }
  return coder.finish();
}

Bytes code_coefficients(const BuiltMesh& mesh, const BuiltGroup& group) {
  if (group.header.profile == Profile::kFast) {
    return code_lanes(LaneField(mesh.surface.graph, mesh.surface.lanes(), group.header.wary()),
                      group.header.component_count, group.coefficients);
  }
  const bool thesis = group.header.profile == Profile::kThesis;
  Field field(
      mesh.surface.graph,
      thesis ? unpredicted_field_options() : surface_field_options(group.header.weak_prior()), 1);
  field.learn_reference(mesh.surface.points(), mesh.surface.order);
  BinaryEncoder coder;
  code_components(field, coder, group.header.component_count, group.coefficients);
  return coder.finish();
}

Bytes code_basis(const BuiltGroup& group) {
  const TemporalGraph temporal = build_temporal_graph(group.header.frame_count);
  if (group.header.profile == Profile::kFast) {
    const std::vector<float> weights = prior_weights(temporal.graph);
    return code_lanes(LaneField(temporal.graph, weights), group.header.component_count + 1,
                      group.basis);
  }
  Field field(temporal.graph, basis_field_options(), 1);
  BinaryEncoder coder;
  code_components(field, coder, group.header.component_count + 1, group.basis);
  return coder.finish();
}

Bytes code_motion(const BuiltMesh& mesh, const BuiltGroup& group) {
  const GroupHeader& h = group.header;
  MotionModel motion(h.region_count, h.component_count);
  for (uint32_t row = 0; row < mesh.rows(); ++row) motion.bindings().push_back(group.binding(row));
  for (uint32_t k = 0; k < h.component_count; ++k) {
    for (uint32_t b = 0; b < h.region_count; ++b)
      motion.transforms(k).push_back(group.transform(k, b));
  }
  BinaryEncoder coder;
  const uint32_t stride = h.profile == Profile::kThesis ? MotionModel::kFrameStride : 0;
  motion.code(coder, mesh.surface.graph, stride);
  return coder.finish();
}

/// The order of the coding vertices, which is that of the input.
Bytes code_order_as_is(const MeshState& state) {
  std::vector<uint32_t> index(state.vertex_count);
  std::iota(index.begin(), index.end(), 0u);
  IntervalEncoder coder;
  const std::vector<uint32_t> triangles = collect_triangles(state);
  require(code_vertex_order(coder, TriangleTopology(state.vertex_count, triangles), index));
  return coder.finish();
}

/// Counts the corrections as it codes them.
Bytes code_corrections(const BuiltMesh& mesh, BuiltGroup& group) {
  CorrectionField field(mesh.surface.graph, group.header.frame_count);
  BinaryEncoder coder;
  group.header.correction_count = 0;
  field.code(coder, group.correction, [&](uint32_t, uint32_t, uint32_t, const Correction&) {
    ++group.header.correction_count;
    return true;
  });
  return coder.finish();
}

}  // namespace

BuiltMesh build_mesh(const Connectivity& connectivity, std::span<const int32_t> grid,
                     const ReferenceOptions& options) {
  Bytes bytes;
  ReferenceMesh decoded;
  std::vector<uint32_t> input;
  require(encode_reference(connectivity, grid, options, bytes, decoded, input));
  return finish_mesh(std::move(bytes));
}

BuiltMesh build_listed_mesh(const Connectivity& connectivity, std::span<const int32_t> grid,
                            bool order_kept) {
  MeshState state;
  state.vertex_count = connectivity.vertex_count;
  state.face_count = static_cast<uint32_t>(connectivity.face_sizes.size());
  state.grid.assign(grid.begin(), grid.end());
  state.listed = {connectivity.face_sizes, connectivity.corners};
  IntervalEncoder coder;
  const TriangleTopology no_triangles(0, {});
  require(code_rest(coder, &no_triangles, state, {}));
  const Bytes rest = coder.finish();
  const Bytes order = order_kept ? code_order_as_is(state) : Bytes{};
  MeshHeader header = {.vertex_count = state.vertex_count, .face_count = state.face_count};
  header.flags = order_kept ? MeshHeader::kOrderKept : 0;
  header.rest_bytes = rest.size();
  header.order_bytes = order.size();
  Bytes bytes;
  require(write_header(header, "mesh header", bytes));
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  bytes.insert(bytes.end(), order.begin(), order.end());
  return finish_mesh(std::move(bytes));
}

BuiltMesh with_face_section(const BuiltMesh& mesh, const Bytes& faces, bool order_dropped) {
  ByteReader in(mesh.bytes);
  MeshHeader header;
  require(read_header(in, "mesh header", header));
  const uint64_t order_bytes = order_dropped ? header.order_bytes : 0;
  const std::span<const uint8_t> sections =
      in.take(in.remaining() - header.face_bytes - order_bytes);
  if (order_dropped) header.flags &= static_cast<uint8_t>(~MeshHeader::kOrderKept);
  header.order_bytes -= order_bytes;
  header.face_bytes = faces.size();
  Bytes bytes;
  require(write_header(header, "mesh header", bytes));
  bytes.insert(bytes.end(), sections.begin(), sections.end());
  bytes.insert(bytes.end(), faces.begin(), faces.end());
  return finish_mesh(std::move(bytes));
}

bool set_correction_section(const BuiltMesh& mesh, BuiltGroup& group, Bytes bytes) {
  CorrectionField field(mesh.surface.graph, group.header.frame_count);
  BinaryDecoder decoder(bytes);
  group.header.correction_count = 0;
  const bool sound = field.code(
      decoder, [](uint32_t, uint32_t, uint32_t) { return Correction(); },
      [&](uint32_t, uint32_t, uint32_t, const Correction& c) {
        ++group.header.correction_count;
        return std::isfinite(c.value);
      });
  group.header.flags |= GroupHeader::kCorrected;
  group.correction_section = std::move(bytes);
  return sound && !decoder.overrun();
}

void build_sections(const BuiltMesh& mesh, BuiltGroup& group) {
  const GroupHeader& h = group.header;
  if (group.coefficients) group.coefficient_section = code_coefficients(mesh, group);
  if (group.basis) group.basis_section = code_basis(group);
  if (group.binding && h.region_count > 0) group.motion_section = code_motion(mesh, group);
  if (group.correction) {
    group.header.flags |= GroupHeader::kCorrected;
    group.correction_section = code_corrections(mesh, group);
  }
}

FileBuilder::FileBuilder(const SequenceHeader& header) { require(writer_.begin(header)); }

void FileBuilder::reference(const ReferenceHeader& header, const BuiltMesh& mesh) {
  require(writer_.reference(header, mesh.bytes));
}

void FileBuilder::group(const BuiltMesh& mesh, BuiltGroup group) {
  build_sections(mesh, group);
  const GroupSections sections = {group.motion_section, group.coefficient_section,
                                  group.basis_section, group.correction_section};
  Bytes padded;
  require(writer_.group(group.header,
                        within_element_bound(group.header, mesh.rows(), sections, padded)));
}

void FileBuilder::metadata(const std::vector<MetadataEntry>& entries) {
  require(writer_.metadata(entries));
}

void FileBuilder::chunk(const char* type, const Bytes& payload) {
  ChunkType letters;
  std::copy_n(type, letters.size(), letters.begin());
  append_chunk(bytes_, letters, payload);
}

Bytes FileBuilder::finish() {
  require(writer_.finish());
  return bytes_;
}

Bytes build_file(const BuiltMesh& mesh, const BuiltGroup& group) {
  FileBuilder file({.total_frames = group.header.frame_count});
  file.reference({}, mesh);
  file.group(mesh, group);
  return file.finish();
}

Bytes random_bytes(uint32_t seed, size_t count) {
  std::mt19937 random(seed);
  Bytes out(count);
  for (uint8_t& b : out) b = static_cast<uint8_t>(random() >> 24);
  return out;
}

}  // namespace reeb::conformance
