#include "codec/dec/group_decoder.h"

#include <cmath>
#include <utility>

#include "codec/common/base/largest_magnitude.h"
#include "codec/common/fast/lane_field.h"
#include "codec/common/motion/motion_syntax.h"
#include "codec/common/synthesis/correction_field.h"
#include "codec/dec/lossless_decoder.h"

namespace reeb {

namespace {

/// Decodes the next component of a field; false when the bytes do not suffice or a value is beyond
/// binary32.
bool decode_component(Field& field, BinaryDecoder& decoder) {
  BinaryDecoder local = decoder;  // of which the compiler knows that nothing else changes it
  field.code_component([&](uint32_t, float, uint32_t, MagnitudeModel::Bins& bins) {
    return field.model().code(local, bins, 0);
  });
  decoder = local;
  const std::vector<float>& plane = field.plane(field.component_count() - 1);
  return std::isfinite(largest_magnitude(plane)) && !decoder.overrun();
}

/// What the fields of the header must be to each other.
Status check_header(const GroupHeader& h) {
  const uint64_t coordinates = 3 * uint64_t{h.frame_count};
  const bool thesis = h.profile == Profile::kThesis;
  if (h.component_count > coordinates || (thesis && h.component_count != coordinates)) {
    return Status::corrupt("component_count does not fit the group's frames");
  }
  if (h.region_count > MotionModel::kMaxRegions) {
    return Status::corrupt("region_count is out of range");
  }
  const bool continues = (h.flags & GroupHeader::kContinues) != 0;
  if (h.profile != Profile::kMain && continues) {
    return Status::corrupt("a group continues another in a profile where none does");
  }
  const bool learns = h.profile == Profile::kMain || h.profile == Profile::kFast;
  if (h.weak_prior() && (!learns || continues)) {
    return Status::corrupt("a group has weights of a weak prior, but does not start to learn any");
  }
  if ((h.region_count == 0 && h.motion_bytes > 0) || (thesis && h.basis_bytes > 0)) {
    return Status::corrupt("a section is there that the group does not use");
  }
  return {};
}

Status decode_motion(const GroupChunk& chunk, const DecodedSurface& surface, MotionModel& motion) {
  if (chunk.header.region_count == 0) return {};
  BinaryDecoder decoder(chunk.motion);
  motion = MotionModel(chunk.header.region_count, chunk.header.component_count);
  const uint32_t stride = chunk.header.profile == Profile::kThesis ? MotionModel::kFrameStride : 0;
  if (!motion.code(decoder, surface.surface.graph, stride) || decoder.overrun()) {
    return Status::corrupt("the motion section is damaged");
  }
  motion.locate(GridPoints(surface.grid), surface.surface.order);
  return {};
}

/// Leaves in `state` what the group starts from.
Status start_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                   GroupState& state) {
  const Profile profile = chunk.header.profile;
  if (!chunk.continues()) {
    state = start_closed_group(surface.surface, GridPoints(surface.grid), profile,
                               chunk.header.weak_prior(), threads);
    return {};
  }
  if (state.coefficients != nullptr && state.profile == profile) return {};
  return Status::corrupt("a group continues one that is not there or of another profile");
}

bool decode_basis_planes(const GroupChunk& chunk, const PredictionGraph& graph,
                         const StopToken& stop, MagnitudeModel& contexts,
                         std::vector<std::vector<float>>& planes) {
  const uint32_t count = chunk.header.component_count + 1;
  if (chunk.header.profile == Profile::kFast) {
    const std::vector<float> weights = prior_weights(graph);
    LaneField field(graph, weights);
    return decode_lane_field(chunk.basis, count, field, planes, stop);
  }
  Field field(graph, basis_field_options(), 1);
  std::swap(field.model(), contexts);
  field.expect(count);
  BinaryDecoder decoder(chunk.basis);
  for (uint32_t k = 0; k < count; ++k) {
    if (stop.requested() || !decode_component(field, decoder)) return false;
  }
  std::swap(field.model(), contexts);
  planes = field.take_planes();
  return true;
}

Status decode_basis(const GroupChunk& chunk, const DecodedSurface& surface,
                    std::vector<std::vector<float>> planes, const StopToken& stop,
                    GroupState& state, GroupSynthesis& out) {
  const TemporalGraph temporal = build_temporal_graph(chunk.header.frame_count);
  std::vector<std::vector<float>> basis;
  if (!decode_basis_planes(chunk, temporal.graph, stop, state.basis_contexts, basis))
    return stop.requested() ? Status::cancelled() : Status::corrupt("the basis section is damaged");
  const double q = static_cast<double>(chunk.header.quantization_step);
  out = synthesize(std::move(planes), basis, temporal.order, q, surface.origin, surface.output);
  return {};
}

Status decode_corrections(const GroupChunk& chunk, const DecodedSurface& surface,
                          GroupSynthesis& out) {
  const GroupHeader& h = chunk.header;
  if (h.correction_count == 0) return {};
  Corrections corrections(h.frame_count, h.correction_step);
  CorrectionField field(surface.surface.graph, h.frame_count);
  BinaryDecoder decoder(chunk.corrections);
  uint64_t count = 0;
  const bool in_range = field.code(
      decoder, [](uint32_t, uint32_t, uint32_t) { return Correction(); },
      [&](uint32_t row, uint32_t t, uint32_t axis, const Correction& c) {
        corrections.add(surface.output[row], t, axis, c);
        return std::isfinite(c.value) && ++count <= h.correction_count && !decoder.overrun();
      });
  if (!in_range || count != h.correction_count || decoder.overrun())
    return Status::corrupt("the correction section is damaged");
  out.set_corrections(std::move(corrections));
  return {};
}

}  // namespace

bool decode_coefficients(std::span<const uint8_t> bytes, uint32_t count, Field& field,
                         const StopToken& stop) {
  BinaryDecoder decoder(bytes);
  for (uint32_t k = 0; k < count; ++k) {
    if (stop.requested() || !decode_component(field, decoder)) return false;
  }
  return true;
}

namespace {

Status coefficient_status(bool whole, const StopToken& stop) {
  if (stop.requested()) return Status::cancelled();
  return whole ? Status() : Status::corrupt("the coefficient section is damaged");
}

/// The planes of the coefficient section, fast profile.
Status decode_lane_planes(const GroupChunk& chunk, const DecodedSurface& surface,
                          const StopToken& stop, std::vector<std::vector<float>>& planes) {
  LaneStart own;  // of a mesh that is not plain
  if (surface.lanes.empty()) own = lane_start(surface.surface, GridPoints(surface.grid));
  LaneField field(surface.surface.graph, own.empty() ? surface.lanes : own, chunk.header.wary());
  return coefficient_status(
      decode_lane_field(chunk.coefficients, chunk.header.component_count, field, planes, stop),
      stop);
}

/// The same of the other profiles.
Status decode_planes(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                     bool keep, const StopToken& stop, GroupState& state,
                     std::vector<std::vector<float>>& planes) {
  const uint32_t count = chunk.header.component_count;
  if (Status s = start_group(chunk, surface, threads, state); !s.ok()) return s;
  if (!keep) state.coefficients->expect(count);
  const bool whole = decode_coefficients(chunk.coefficients, count, *state.coefficients, stop);
  if (Status s = coefficient_status(whole, stop); !s.ok()) return s;
  planes = keep ? state.coefficients->next_group() : state.coefficients->take_planes();
  return {};
}

}  // namespace

Status decode_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                    bool keep, GroupState& state, GroupSynthesis& out, const StopToken& stop) {
  const GroupHeader& header = chunk.header;
  if (header.profile != Profile::kFast && !surface.lanes.empty())
    return Status::corrupt("the group's profile does not fit its reference mesh");
  if (header.profile == Profile::kLossless) {
    state = {};
    ExactFrames frames;
    if (Status s = decode_lossless_group(chunk, surface, threads, stop, frames); !s.ok()) return s;
    out = GroupSynthesis(std::move(frames), surface.output);
    return {};
  }
  if (Status s = check_header(header); !s.ok()) return s;
  MotionModel motion;
  if (Status s = decode_motion(chunk, surface, motion); !s.ok()) return s;
  std::vector<std::vector<float>> planes;
  if (Status s = header.profile == Profile::kFast
                     ? decode_lane_planes(chunk, surface, stop, planes)
                     : decode_planes(chunk, surface, threads, keep, stop, state, planes);
      !s.ok())
    return s;
  if (motion.regions() > 0) add_motion(motion, planes);
  if (header.profile == Profile::kThesis) {
    out = GroupSynthesis(std::move(planes), header.axis_step, surface.origin, surface.output);
  } else if (Status s = decode_basis(chunk, surface, std::move(planes), stop, state, out);
             !s.ok()) {
    return s;
  }
  if (Status s = decode_corrections(chunk, surface, out); !s.ok()) return s;
  if (!keep) state = {};
  return out.finite() ? Status() : Status::corrupt("the group's basis is out of range");
}

}  // namespace reeb
