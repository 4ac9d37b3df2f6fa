#include "codec/dec/group_memory.h"

#include <algorithm>

#include "codec/common/fields/field.h"
#include "codec/common/motion/motion_model.h"
#include "codec/common/prediction/weight_kernels.h"
#include "codec/common/synthesis/correction_field.h"
#include "codec/dec/connectivity/connectivity_decoder.h"

namespace reeb {

namespace {

// tests/limits/memory_test.cpp holds all of these to what there is. Of each row of a field while it
// is decoded, beside the surface:
constexpr uint64_t kFieldBytes = 280;                                ///< weights, uses, contexts
constexpr uint64_t kKeptBytes = kFieldBytes + sizeof(RowEquations);  ///< and what is learned
constexpr uint64_t kFastBytes = 240;
constexpr uint64_t kLosslessBytes = 1850;  ///< whose equations have their right sides, too
constexpr uint64_t kBytesPerTime = 7800;   ///< of the basis, with its three axes and its graph
/// Of a reference mesh while it is decoded, without what its connectivity takes.
constexpr uint64_t kMeshBytesPerVertex = 530, kMeshBytesPerFace = 50;
/// Contexts of fields and of all else that is the same for any mesh.
constexpr uint64_t kMeshModels = uint64_t{3} << 15;
constexpr uint64_t kModels = uint64_t{3} << 17;
constexpr uint64_t kGridBytes = 3 * (uint64_t{8} << 16);  ///< of the levels of a frame's grid
constexpr uint64_t kLosslessModels = (uint64_t{5} << 17) + kGridBytes;
constexpr uint64_t kGrowing = 3;  ///< a list that grows has its old block beside the new one

/// What a group of a profile takes for each row of its fields.
struct FieldMemory {
  uint64_t row = 0;     ///< of the surface
  uint64_t time = 0;    ///< with its three axes
  uint64_t models = 0;  ///< in all
};

FieldMemory field_memory(const GroupHeader& h, bool keep) {
  switch (h.profile) {
    case Profile::kMain: {
      const bool anew = !keep && (h.flags & GroupHeader::kContinues) == 0 &&
                        !Field::keeps_equations(h.component_count);
      return {anew ? kFieldBytes : kKeptBytes, kBytesPerTime, kModels};
    }
    case Profile::kThesis:
      return {kFieldBytes, 0, kModels};
    case Profile::kFast:
      return {kFastBytes, kBytesPerTime, kModels};
    case Profile::kLossless:
      break;
  }
  return {kLosslessBytes, 0, kLosslessModels};
}

/// Of the frames that a lossless group stores.
uint64_t stored_memory(uint64_t vertices, const GroupHeader& h) {
  return h.stored_count * (12 * vertices + kGrowing * sizeof(std::vector<float>)) +
         2 * kGrowing * sizeof(uint32_t) * h.frame_count;
}

uint64_t corrections_memory(const GroupHeader& h) {
  return h.frame_count * sizeof(uint32_t) + Corrections::kEntryBytes * h.correction_count;
}

template <class T, class Allocator>
uint64_t bytes_of(const std::vector<T, Allocator>& v) {
  return v.capacity() * sizeof(T);
}

/// Of the field of the surface, and then of planes that are rearranged while there is still what
/// the next group learns from.
uint64_t surface_memory(uint64_t vertices, const GroupHeader& h, bool keep) {
  const uint64_t planes =
      h.component_count * (4 * vertices + kGrowing * sizeof(std::vector<float>));
  const uint64_t field = vertices * field_memory(h, keep).row;
  if (h.profile == Profile::kThesis || h.profile == Profile::kLossless) return field + planes;
  const uint64_t tiles = h.component_count * 4 * (vertices + kTileRows) + 2 * 4 * vertices;
  return planes + std::max(field, tiles + (keep ? state_memory(vertices) : 0));
}

}  // namespace

uint64_t reference_memory(const MeshHeader& header, uint64_t coded_triangles) {
  return header.vertex_count * kMeshBytesPerVertex + header.face_count * kMeshBytesPerFace +
         coded_triangles * kConnectivityMemoryPerTriangle + kMeshModels;
}

uint64_t group_memory(uint64_t vertices, const GroupHeader& h, bool keep) {
  const FieldMemory field = field_memory(h, keep);
  const uint64_t components = h.component_count;
  // The basis is there as it was decoded, by component in binary64, and by frame.
  const uint64_t basis = h.frame_count * (field.time + uint64_t{48} * (components + 1));
  const uint64_t motion = components * (sizeof(std::vector<MotionModel::Transform>) +
                                        uint64_t{h.region_count} * sizeof(MotionModel::Transform));
  const bool corrected = h.correction_count > 0;
  const uint64_t corrections =
      corrected ? CorrectionField::memory(vertices, h.frame_count, h.correction_count) +
                      corrections_memory(h)
                : 0;
  return surface_memory(vertices, h, keep) + basis + motion + corrections +
         stored_memory(vertices, h) + field.models;
}

uint64_t state_memory(uint64_t vertices) { return vertices * kKeptBytes + kModels; }

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
