// The sections of a GRUP chunk on a mesh and behind headers that are always the same. Input: a byte
// that chooses the header, two bytes each for the lengths of all sections but the last, the
// sections.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "bitstream/bytes.h"
#include "bitstream/container.h"
#include "codec/dec/group_decoder.h"
#include "tests/codec/shapes.h"

namespace {

using reeb::GroupHeader;
using reeb::Profile;

constexpr uint32_t kFrames = 8;

reeb::DecodedSurface make_surface() {
  const reeb::test::Shape shape = reeb::test::torus(8, 6);
  reeb::DecodedSurface out;
  reeb::ReferenceMesh mesh;
  mesh.grid = reeb::test::on_grid(shape, 9);
  mesh.triangles = reeb::test::triangles_of(shape.connectivity);
  out.surface = reeb::Surface(mesh);
  out.output = out.surface.order;
  return out;
}

/// Every profile, with and without a motion model and corrections.
GroupHeader make_header(uint8_t choice) {
  constexpr std::array kProfiles = {Profile::kMain, Profile::kFast, Profile::kThesis,
                                    Profile::kLossless};
  GroupHeader h;
  h.frame_count = kFrames;
  h.profile = kProfiles[choice % kProfiles.size()];
  if (h.profile == Profile::kLossless) {
    h.stored_count = 6;
    h.flags = (choice & 0x20) != 0 ? GroupHeader::kQuick : 0;
    return h;
  }
  h.component_count = h.profile == Profile::kThesis ? 3 * kFrames : 6;
  h.quantization_step = 0.01f;
  h.region_count = (choice & 0x40) != 0 ? 3 : 0;
  if ((choice & 0x80) != 0) {
    h.flags = GroupHeader::kCorrected;
    h.correction_step = 0.01;
    h.correction_count = choice >> 2 & 7;
  }
  return h;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const reeb::DecodedSurface surface = make_surface();
  reeb::ByteReader in({data, size});
  reeb::GroupChunk chunk;
  chunk.header = make_header(in.u8());
  std::array<uint32_t, 3> lengths;
  for (uint32_t& length : lengths) length = in.u8() | uint32_t{in.u8()} << 8;
  if (!in.ok()) return 0;
  chunk.motion = in.take(std::min<size_t>(lengths[0], in.remaining()));
  chunk.coefficients = in.take(std::min<size_t>(lengths[1], in.remaining()));
  chunk.basis = in.take(std::min<size_t>(lengths[2], in.remaining()));
  chunk.corrections = in.take(in.remaining());
  if (chunk.header.profile == Profile::kLossless) {
    chunk.differences = std::exchange(chunk.coefficients, {});
    chunk.raw = std::exchange(chunk.basis, {});
  }
  for (const reeb::GroupSection& s : reeb::kGroupSections)
    chunk.header.*s.bytes = (chunk.*s.data).size();
  reeb::GroupState state;
  reeb::GroupSynthesis synthesis;
  if (!reeb::decode_group(chunk, surface, 1, false, state, synthesis).ok()) return 0;
  if (synthesis.frame_count() != kFrames) __builtin_trap();
  std::vector<float> xyz(surface.output.size() * 3);
  for (const uint32_t t : {0u, kFrames - 1}) synthesis.frame(t, xyz.data(), 3);
  return 0;
}
