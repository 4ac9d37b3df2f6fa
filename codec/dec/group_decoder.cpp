#include "codec/dec/group_decoder.h"

#include <cmath>
#include <utility>

#include "codec/common/field.h"
#include "codec/common/motion_syntax.h"

namespace reeb {

namespace {

/// Decodes the next component of a field; false when the bytes do not suffice or a value is beyond
/// binary32.
bool decode_component(Field& field, BinaryDecoder& decoder) {
  field.code_component([&](uint32_t, float, uint32_t, MagnitudeModel::Bins& bins) {
    return field.model().code(decoder, bins, 0);
  });
  for (const float x : field.plane(field.component_count() - 1)) {
    if (!std::isfinite(x)) return false;
  }
  return !decoder.overrun();
}

Status decode_motion(const GroupChunk& chunk, const DecodedSurface& surface, MotionModel& motion) {
  if (chunk.header.region_count == 0) return {};
  if (chunk.header.region_count > MotionModel::kMaxRegions)
    return Status::corrupt("region_count is out of range");
  BinaryDecoder decoder(chunk.motion);
  motion = MotionModel(chunk.header.region_count, chunk.header.component_count);
  const uint32_t stride = chunk.header.profile == Profile::kThesis ? MotionModel::kFrameStride : 0;
  if (!motion.code(decoder, surface.surface.graph, stride) || decoder.overrun()) {
    return Status::corrupt("the motion section is damaged");
  }
  motion.locate(GridPoints(surface.grid), surface.surface.order);
  return {};
}

Status decode_coefficients(const GroupChunk& chunk, const DecodedSurface& surface,
                           const MotionModel& motion, unsigned threads,
                           std::vector<std::vector<float>>& planes) {
  Field field(surface.surface.graph, surface_field_options(chunk.header.profile), threads);
  field.learn_reference(GridPoints(surface.grid), surface.surface.order);
  BinaryDecoder decoder(chunk.coefficients);
  for (uint32_t k = 0; k < chunk.header.component_count; ++k) {
    if (!decode_component(field, decoder))
      return Status::corrupt("the coefficient section is damaged");
  }
  planes = field.take_planes();
  if (motion.regions() > 0) add_motion(motion, planes);
  return {};
}

Status decode_basis(const GroupChunk& chunk, const DecodedSurface& surface,
                    std::vector<std::vector<float>> planes, GroupSynthesis& out) {
  const TemporalGraph temporal = build_temporal_graph(chunk.header.frame_count);
  Field basis(temporal.graph, basis_field_options(), 1);
  BinaryDecoder decoder(chunk.basis);
  for (uint32_t k = 0; k <= chunk.header.component_count; ++k) {
    if (!decode_component(basis, decoder)) return Status::corrupt("the basis section is damaged");
  }
  const double q = static_cast<double>(chunk.header.quantization_step);
  out = synthesize(surface.surface.graph.size(), std::move(planes), basis, temporal.order, q,
                   surface.origin);
  return {};
}

}  // namespace

Status decode_group(const GroupChunk& chunk, const DecodedSurface& surface, unsigned threads,
                    GroupSynthesis& out) {
  const GroupHeader& header = chunk.header;
  const uint64_t coordinates = 3 * uint64_t{header.frame_count};
  const bool thesis = header.profile == Profile::kThesis;
  if (header.component_count > coordinates || (thesis && header.component_count != coordinates)) {
    return Status::corrupt("component_count does not fit the group's frames");
  }
  MotionModel motion;
  if (Status s = decode_motion(chunk, surface, motion); !s.ok()) return s;
  std::vector<std::vector<float>> planes;
  if (Status s = decode_coefficients(chunk, surface, motion, threads, planes); !s.ok()) return s;
  if (!thesis) return decode_basis(chunk, surface, std::move(planes), out);
  out = GroupSynthesis(std::move(planes), header.axis_step, surface.origin);
  return {};
}

}  // namespace reeb
