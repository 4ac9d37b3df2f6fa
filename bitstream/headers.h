// Every header of the format, each described once (see `syntax.h`). Field names are those of the
// specification, `spec/container.md`; adding a field is one member and one line of its description.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bitstream/profile.h"

namespace reeb {

inline constexpr uint8_t kFormatVersion = 1;
inline constexpr uint32_t kMaxGroupFrames = 65536;
inline constexpr uint32_t kMaxOpenGroups = 63;  ///< in a row, each continuing the one before
inline constexpr uint32_t kMaxVertices = 1u << 25;
inline constexpr uint64_t kMaxUint32 = std::numeric_limits<uint32_t>::max();

/// Chunk `HEAD`.
struct SequenceHeader {
  /// total_frames and shot_count are upper bounds: the file was written as its frames arrived.
  static constexpr uint8_t kOpenEnded = 1;
  uint32_t total_frames = 1;
  uint32_t shot_count = 1;  ///< runs of frames with one connectivity
  double frame_rate = 0;    ///< frames per second; 0 where unknown
  double start_time = 0;    ///< time of the first frame, in frames
  uint8_t flags = 0;
  bool operator==(const SequenceHeader&) const = default;
};

template <class V>
void describe(V& v, SequenceHeader& h) {
  v.uv("total_frames", h.total_frames, 1, kMaxUint32);
  v.uv("shot_count", h.shot_count, 1, h.total_frames);
  v.f64("frame_rate", h.frame_rate, 0, 1e9);
  v.f64("start_time", h.start_time, -1e15, 1e15);
  v.flags("flags", h.flags, SequenceHeader::kOpenEnded);
}

/// Front of chunk `REFM`; a MeshHeader and its sections follow.
struct ReferenceHeader {
  uint32_t shot = 0;
  uint32_t first_frame = 0;     ///< of the shot, in the sequence
  float origin[3] = {0, 0, 0};  ///< position of grid point (0,0,0), world units
  float grid_step = 1;          ///< world units per grid step
  uint8_t flags = 0;            ///< reserved
  bool operator==(const ReferenceHeader&) const = default;
};

template <class V>
void describe(V& v, ReferenceHeader& h) {
  constexpr double kMaxFloat = std::numeric_limits<float>::max();
  v.uv("shot", h.shot, 0, kMaxUint32);
  v.uv("first_frame", h.first_frame, 0, kMaxUint32);
  v.f32("origin_x", h.origin[0], -kMaxFloat, kMaxFloat);
  v.f32("origin_y", h.origin[1], -kMaxFloat, kMaxFloat);
  v.f32("origin_z", h.origin[2], -kMaxFloat, kMaxFloat);
  v.f32("grid_step", h.grid_step, 0, kMaxFloat);
  v.flags("flags", h.flags, 0);
}

/// Front of a coded reference mesh; its sections follow in this order and fill the rest.
struct MeshHeader {
  static constexpr uint8_t kOrderKept = 1;      ///< vertices come back in the order of the input
  static constexpr uint8_t kFaceOrderKept = 2;  ///< faces, too, and their first corners
  static constexpr uint8_t kPlain = 4;          ///< of the fast profile
  uint32_t vertex_count = 1;
  uint32_t face_count = 0;
  uint8_t flags = 0;
  uint64_t draco_bytes = 0;     ///< connectivity as Draco writes it; 0 where there is none
  uint64_t rest_bytes = 0;      ///< what that does not carry
  uint64_t position_bytes = 0;  ///< where plain: positions, which are in the rest otherwise
  uint64_t order_bytes = 0;     ///< permutation to the order of the input
  uint64_t face_bytes = 0;      ///< order and first corners of the faces
  bool operator==(const MeshHeader&) const = default;
};

template <class V>
void describe(V& v, MeshHeader& h) {
  v.uv("vertex_count", h.vertex_count, 1, kMaxVertices);
  v.uv("face_count", h.face_count, 0, kMaxUint32);
  v.flags("flags", h.flags,
          MeshHeader::kOrderKept | MeshHeader::kFaceOrderKept | MeshHeader::kPlain);
  v.uv("draco_bytes", h.draco_bytes, 0, kMaxUint32);
  v.uv("rest_bytes", h.rest_bytes, 0, kMaxUint32);
  if ((h.flags & MeshHeader::kPlain) != 0) v.uv("position_bytes", h.position_bytes, 0, kMaxUint32);
  v.uv("order_bytes", h.order_bytes, 0, kMaxUint32);
  if ((h.flags & MeshHeader::kFaceOrderKept) != 0) {
    v.uv("face_bytes", h.face_bytes, 0, kMaxUint32);
  }
}

/// Front of chunk `GRUP`; the sections follow in this order and fill the rest.
struct GroupHeader {
  static constexpr uint8_t kContinues = 1;      ///< starts from what the group before has learned
  static constexpr uint8_t kQuick = 4;          ///< lossless: the method that decodes quicker
  static constexpr uint8_t kCorrected = 2;      ///< single coordinates are corrected
  static constexpr uint8_t kWeakPrior = 8;      ///< main profile: weights may go far from what
                                                ///< distances tell
  static constexpr uint8_t kWary = kWeakPrior;  ///< fast profile: rows that were predicted badly
                                                ///< change their weights the less
  uint32_t first_frame = 0;                     ///< in the sequence
  uint32_t frame_count = 1;
  uint32_t shot = 0;
  Profile profile = Profile::kMain;
  uint32_t component_count = 0;    ///< terms that positions are the sum of; not in lossless
  uint32_t stored_count = 0;       ///< lossless: frames that are not copies
  float quantization_step = 1;     ///< world units
  float axis_step[3] = {1, 1, 1};  ///< thesis profile: of each coordinate, world units
  uint32_t region_count = 0;       ///< regions of the affine motion model; 0 where it is not used
  uint8_t flags = 0;
  uint64_t motion_bytes = 0;
  uint64_t coefficient_bytes = 0;
  uint64_t basis_bytes = 0;
  uint64_t difference_bytes = 0;  ///< lossless: what is modelled
  uint64_t raw_bytes = 0;         ///< lossless: bits of which nothing is known
  double correction_step = 1;     ///< where corrected: world units
  uint64_t correction_count = 0;  ///< where corrected: coordinates that are
  uint64_t correction_bytes = 0;

  bool weak_prior() const { return (flags & kWeakPrior) != 0; }
  bool wary() const { return (flags & kWary) != 0; }
  bool operator==(const GroupHeader&) const = default;
};

/// Of a lossless group, from stored_count on.
template <class V>
void describe_lossless(V& v, GroupHeader& h) {
  v.uv("stored_count", h.stored_count, 0, 3 * uint64_t{kMaxGroupFrames});
  v.flags("flags", h.flags, GroupHeader::kQuick);
  v.uv("difference_bytes", h.difference_bytes, 0, kMaxUint32);
  v.uv("raw_bytes", h.raw_bytes, 0, kMaxUint32);
}

/// Of a group with components, from component_count on.
template <class V>
void describe_components(V& v, GroupHeader& h) {
  v.uv("component_count", h.component_count, 0, 3 * uint64_t{kMaxGroupFrames});
  v.f32("quantization_step", h.quantization_step, std::numeric_limits<float>::denorm_min(),
        std::numeric_limits<float>::max());
  if (h.profile == Profile::kThesis) {
    constexpr double kMin = std::numeric_limits<float>::denorm_min();
    constexpr double kMax = std::numeric_limits<float>::max();
    v.f32("axis_step_x", h.axis_step[0], kMin, kMax);
    v.f32("axis_step_y", h.axis_step[1], kMin, kMax);
    v.f32("axis_step_z", h.axis_step[2], kMin, kMax);
  }
  v.uv("region_count", h.region_count, 0, kMaxUint32);
  v.flags("flags", h.flags,
          GroupHeader::kContinues | GroupHeader::kCorrected | GroupHeader::kWeakPrior);
  v.uv("motion_bytes", h.motion_bytes, 0, kMaxUint32);
  v.uv("coefficient_bytes", h.coefficient_bytes, 0, kMaxUint32);
  v.uv("basis_bytes", h.basis_bytes, 0, kMaxUint32);
  if ((h.flags & GroupHeader::kCorrected) != 0) {
    v.f64("correction_step", h.correction_step, std::numeric_limits<double>::min(),
          std::numeric_limits<float>::max());
    v.uv("correction_count", h.correction_count, 0, uint64_t{3} * kMaxVertices * kMaxGroupFrames);
    v.uv("correction_bytes", h.correction_bytes, 0, kMaxUint32);
  }
}

template <class V>
void describe(V& v, GroupHeader& h) {
  v.uv("first_frame", h.first_frame, 0, kMaxUint32);
  v.uv("frame_count", h.frame_count, 1, kMaxGroupFrames);
  v.uv("shot", h.shot, 0, kMaxUint32);
  v.u8("profile", h.profile, 0, 3);
  if (h.profile == Profile::kLossless) {
    describe_lossless(v, h);
  } else {
    describe_components(v, h);
  }
}

/// Chunk `meta`: free key/value pairs, UTF-8.
struct MetadataEntry {
  std::string key;
  std::string value;
  bool operator==(const MetadataEntry&) const = default;
};

template <class V>
void describe(V& v, MetadataEntry& h) {
  v.text("key", h.key);
  v.text("value", h.value);
}

struct Metadata {
  std::vector<MetadataEntry> entries;
};

template <class V>
void describe(V& v, Metadata& h) {
  v.list("entry_count", h.entries, 2);
}

/// One entry of the seek table: where a `REFM` or `GRUP` chunk lies.
struct SeekEntry {
  uint64_t gap = 0;   ///< bytes from the end of the chunk of the entry before (or the file's start)
  uint64_t size = 0;  ///< bytes of the whole chunk, type to checksum
  uint32_t frame_count = 0;  ///< of the group; 0 for a reference mesh
  bool operator==(const SeekEntry&) const = default;
};

template <class V>
void describe(V& v, SeekEntry& h) {
  v.uv("gap", h.gap, 0, uint64_t{1} << 62);
  v.uv("size", h.size, 9, uint64_t{1} << 62);
  v.uv("frame_count", h.frame_count, 0, kMaxGroupFrames);
}

/// Chunk `seek`: every reference mesh and group, in file order.
struct SeekTable {
  std::vector<SeekEntry> entries;
};

template <class V>
void describe(V& v, SeekTable& h) {
  v.list("entry_count", h.entries, 3);
}

}  // namespace reeb
