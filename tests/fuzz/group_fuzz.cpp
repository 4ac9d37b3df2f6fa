// The payload of a GRUP chunk on a mesh that is always the same.
#include "bitstream/container.h"
#include "bitstream/syntax.h"
#include "codec/dec/group_decoder.h"
#include "tests/codec/shapes.h"

namespace {

reeb::DecodedSurface make_surface() {
  const reeb::test::Shape shape = reeb::test::torus(8, 6);
  reeb::DecodedSurface out;
  out.grid = reeb::test::on_grid(shape, 9);
  out.surface = reeb::build_surface_graph(reeb::GridPoints(out.grid),
                                          reeb::test::triangles_of(shape.connectivity));
  out.output = out.surface.order;
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const reeb::DecodedSurface surface = make_surface();
  reeb::ByteReader in({data, size});
  reeb::GroupChunk chunk;
  if (!reeb::read_header(in, "GRUP", chunk.header).ok()) return 0;
  // More would be refused by the limits before the group is decoded.
  if (chunk.header.frame_count > 500) return 0;
  chunk.motion = in.take(chunk.header.motion_bytes);
  chunk.coefficients = in.take(chunk.header.coefficient_bytes);
  chunk.basis = in.take(chunk.header.basis_bytes);
  if (!in.ok()) return 0;
  reeb::GroupSynthesis synthesis;
  if (!reeb::decode_group(chunk, surface, 1, synthesis).ok()) return 0;
  if (synthesis.frame_count() != chunk.header.frame_count) __builtin_trap();
  std::vector<float> xyz(surface.output.size() * 3);
  synthesis.frame(chunk.header.frame_count - 1, surface.output, xyz.data(), 3);
  return 0;
}
