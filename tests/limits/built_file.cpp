#include "tests/limits/built_file.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "bitstream/element_bound.h"
#include "codec/common/fields/group_state.h"
#include "codec/common/synthesis/correction_field.h"
#include "codec/enc/lossless/lossless_group_encoder.h"
#include "codec/enc/reference/reference_mesh_encoder.h"
#include "entropy/range_coder.h"
#include "entropy/rans.h"

namespace reeb::test {

CodedMesh code_mesh(const Shape& shape, bool plain, uint32_t bits) {
  CodedMesh out;
  ReferenceMesh decoded;
  std::vector<uint32_t> input;
  ReferenceOptions options;
  options.plain = plain;
  const Status status = encode_reference(shape.connectivity, on_grid(shape, bits), options,
                                         out.bytes, decoded, input);
  REQUIRE(status.ok());
  out.surface = Surface(decoded);
  return out;
}

Bytes file_of(const CodedMesh& mesh, const GroupHeader& header, const GroupSections& sections) {
  Bytes out, padded;
  ContainerWriter writer(out);
  REQUIRE(writer.begin({.total_frames = header.frame_count}).ok());
  REQUIRE(writer.reference({}, mesh.bytes).ok());
  REQUIRE(writer.group(header, within_element_bound(header, mesh.surface.rows(), sections, padded))
              .ok());
  REQUIRE(writer.finish().ok());
  return out;
}

Bytes code_zeros(Field& field, uint32_t components) {
  BinaryEncoder coder;
  for (uint32_t k = 0; k < components; ++k) {
    field.code_component([&](uint32_t, float, uint32_t, MagnitudeModel::Bins& bins) {
      return field.model().code(coder, bins, 0);
    });
  }
  return coder.finish();
}

Bytes zero_basis(uint32_t frames, uint32_t components) {
  const TemporalGraph times = build_temporal_graph(frames);
  Field field(times.graph, basis_field_options(), 1);
  return code_zeros(field, components + 1);
}

Bytes zero_file(const CodedMesh& mesh, Profile profile, uint32_t frames, uint32_t components) {
  GroupHeader h;
  h.frame_count = frames;
  h.profile = profile;
  h.component_count = components;
  Bytes coefficients, basis;
  if (profile == Profile::kFast) {
    coefficients = RansEncoder(std::min(kRansLanes, components)).finish();
    basis = RansEncoder(std::min(kRansLanes, components + 1)).finish();
  } else {
    const GroupState state = start_closed_group(mesh.surface, mesh.surface.points(), false, 1);
    coefficients = code_zeros(*state.coefficients, components);
    basis = zero_basis(frames, components);
  }
  return file_of(mesh, h, {.coefficients = coefficients, .basis = basis});
}

Bytes corrected_file(const CodedMesh& mesh, uint32_t frames) {
  GroupHeader h;
  h.frame_count = frames;
  h.flags = GroupHeader::kCorrected;
  h.correction_step = 1;
  h.correction_count = uint64_t{3} * frames * mesh.surface.rows();
  const Bytes basis = zero_basis(frames, 0);
  CorrectionField corrections(mesh.surface.graph, frames);
  BinaryEncoder coder;
  corrections.code(
      coder,
      [](uint32_t row, uint32_t, uint32_t) {
        return Correction{row % 2 == 0 ? 1 : -1, false, 0};
      },
      [](auto...) { return true; });
  const Bytes section = coder.finish();
  return file_of(mesh, h, {.basis = basis, .corrections = section});
}

Bytes lossless_file(const Shape& shape, const std::vector<std::vector<float>>& frames, bool quick) {
  CodedMesh mesh = code_mesh(shape, false, 12);
  SurfaceContext context;
  std::swap(context.surface, mesh.surface);
  ExactFrames exact;
  for (const std::vector<float>& frame : frames) exact.add(frame);
  const LosslessGroup coded = encode_lossless_group(context, exact, {.quick = quick}, 1);
  std::swap(context.surface, mesh.surface);
  GroupHeader h;
  h.frame_count = coded.frame_count;
  h.stored_count = coded.stored_count;
  h.profile = Profile::kLossless;
  if (quick) h.flags = GroupHeader::kQuick;
  return file_of(mesh, h, {.differences = coded.differences, .raw = coded.raw});
}

}  // namespace reeb::test
