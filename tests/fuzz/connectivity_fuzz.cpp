// The connectivity of a reference mesh: what decodes, Draco reads the same.
#include "tests/codec/draco_reading.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const reeb::Limits limits{
      .max_vertices = 1u << 16, .max_faces = 1u << 16, .max_frames = 1, .max_memory = 64u << 20};
  reeb::PointTriangles mesh, by_draco;
  if (!reeb::decode_connectivity({data, size}, limits, 1u << 16, mesh).ok()) return 0;
  if (!reeb::test::read_by_draco({data, size}, by_draco)) __builtin_trap();
  if (mesh.point_count != by_draco.point_count || mesh.triangles != by_draco.triangles)
    __builtin_trap();
  return 0;
}
