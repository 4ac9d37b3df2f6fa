#include "codec/dec/group_memory.h"

#include "codec/common/fields/field.h"
#include "codec/common/motion/motion_model.h"
#include "codec/common/prediction/weight_kernels.h"
#include "codec/common/synthesis/correction_field.h"
#include "codec/dec/connectivity/connectivity_decoder.h"

namespace reeb {

namespace {

/// Of weights, graph and contexts of a field while it is decoded.
constexpr uint64_t kBytesPerRow = 2600;
constexpr uint64_t kFastBytesPerRow = 800;  ///< whose equations are not kept
constexpr uint64_t kBytesPerTime = 3 * kBytesPerRow;
/// Of a reference mesh while it is decoded, without what its connectivity takes.
constexpr uint64_t kMeshBytesPerVertex = 720, kMeshBytesPerFace = 80;

/// What a group of a profile takes for each row of its fields.
struct FieldMemory {
  uint64_t row = 0;   ///< of the surface
  uint64_t time = 0;  ///< with its three axes
};

FieldMemory field_memory(Profile profile) {
  switch (profile) {
    case Profile::kMain:
    case Profile::kThesis:
      return {kBytesPerRow, kBytesPerTime};
    case Profile::kFast:
      return {kFastBytesPerRow, kBytesPerTime};
    case Profile::kLossless:
      break;
  }
  return {kBytesPerRow, 0};
}

/// Of the frames that a lossless group stores.
uint64_t stored_memory(uint64_t vertices, const GroupHeader& h) {
  return h.stored_count * (12 * vertices + 2 * sizeof(std::vector<float>)) +
         2 * sizeof(uint32_t) * h.frame_count;
}

uint64_t corrections_memory(const GroupHeader& h) {
  return h.frame_count * sizeof(uint32_t) + Corrections::kEntryBytes * h.correction_count;
}

template <class T, class Allocator>
uint64_t bytes_of(const std::vector<T, Allocator>& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace

uint64_t reference_memory(const MeshHeader& header, uint64_t coded_triangles) {
  return header.vertex_count * kMeshBytesPerVertex + header.face_count * kMeshBytesPerFace +
         coded_triangles * kConnectivityMemoryPerTriangle;
}

uint64_t group_memory(uint64_t vertices, const GroupHeader& h) {
  const FieldMemory field = field_memory(h.profile);
  const uint64_t components = h.component_count;
  const uint64_t surface = vertices * (field.row + 4 * components);
  // The basis is there as it was decoded, by component in binary64, and by frame.
  const uint64_t basis = h.frame_count * (field.time + uint64_t{48} * (components + 1));
  const uint64_t motion = components * (sizeof(std::vector<MotionModel::Transform>) +
                                        uint64_t{h.region_count} * sizeof(MotionModel::Transform));
  const bool corrected = h.correction_count > 0;
  const uint64_t corrections =
      corrected ? CorrectionField::memory(vertices, h.frame_count, h.correction_count) +
                      corrections_memory(h)
                : 0;
  return surface + basis + motion + corrections + stored_memory(vertices, h);
}

// The estimator and its weights, what contexts look back on, and the contexts themselves.
uint64_t state_memory(uint64_t vertices) {
  constexpr uint64_t kBytesPerStateRow = sizeof(RowEquations) + 192;
  return vertices * kBytesPerStateRow + sizeof(MagnitudeModel) + sizeof(Field);
}

uint64_t kept_memory(const DecodedSurface& s) {
  const PredictionGraph& graph = s.surface.graph;
  return sizeof(DecodedSurface) + bytes_of(s.surface.grid) + LaneStart::bytes(graph.size()) +
         bytes_of(s.output) + bytes_of(s.surface.order) + bytes_of(graph.rows) +
         bytes_of(graph.step_index);
}

uint64_t kept_memory(uint64_t vertices, const GroupHeader& h) {
  const uint64_t planes =
      h.component_count * (4 * (vertices + kTileRows) + sizeof(std::vector<float>));
  const uint64_t times = 3 * uint64_t{h.frame_count} * (4 * uint64_t{h.component_count} + 8);
  return sizeof(GroupSynthesis) + planes + times + corrections_memory(h) +
         stored_memory(vertices, h);
}

uint64_t kept_memory(const Connectivity& c) { return bytes_of(c.face_sizes) + bytes_of(c.corners); }

}  // namespace reeb
