// A coded reference mesh without its container, and the graph that is built on it.
#include <algorithm>
#include <vector>

#include "codec/common/prediction/prediction_graph.h"
#include "codec/dec/reference_mesh_decoder.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const reeb::Limits limits{
      .max_vertices = 4096, .max_faces = 8192, .max_frames = 1, .max_memory = 64u << 20};
  reeb::ReferenceMesh mesh;
  if (!reeb::decode_reference({data, size}, limits, mesh).ok()) return 0;
  if (mesh.vertex_count > limits.max_vertices || mesh.grid.size() != 3 * mesh.vertex_count ||
      mesh.output_index.size() != mesh.vertex_count) {
    __builtin_trap();
  }
  std::vector<bool> used(mesh.vertex_count, false);
  for (const uint32_t v : mesh.output_index) {
    if (v >= used.size() || used[v]) __builtin_trap();
    used[v] = true;
  }
  for (const uint32_t v : mesh.triangles) {
    if (v >= mesh.vertex_count) __builtin_trap();
  }
  for (const int32_t x : mesh.grid) {
    if (x < 0 || x > reeb::kGridMax) __builtin_trap();
  }
  const auto graph = reeb::build_surface_graph(reeb::GridPoints(mesh.grid), mesh.triangles);
  if (graph.order.size() != mesh.vertex_count) __builtin_trap();
  return 0;
}
