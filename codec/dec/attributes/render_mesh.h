// A mesh as graphics interfaces take it: one vertex for every combination of a vertex and the
// values of its corners, triangles by material.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/memory_account.h"
#include "codec/common/base/sequence.h"

namespace reeb {

/// What tells the corners of a vertex apart: `bytes` for each corner.
struct CornerKeys {
  const uint8_t* keys = nullptr;
  size_t bytes = 0;
};

struct RenderMesh {
  /// Triangles of faces of one material, `first` .. `first + count` - 1.
  struct Range {
    int64_t material = 0;  ///< value of the material attribute; 0 where there is none
    uint32_t first = 0, count = 0;
  };
  std::vector<uint32_t> source_vertex;  ///< of each render vertex, in the shot's numbering
  std::vector<uint32_t> source_corner;  ///< one that has its values
  std::vector<uint32_t> triangles;      ///< three render vertices each; faces as fans
  std::vector<uint32_t> source_face;    ///< of each triangle
  std::vector<Range> ranges;            ///< rising by material
  uint32_t shot = 0;
  uint32_t shot_vertices = 0;
  int64_t material_attribute = -1;  ///< index; -1 where there is none
  Lease lease;

  uint32_t vertex_count() const { return static_cast<uint32_t>(source_vertex.size()); }
};

/// `material`: a static attribute of the faces with one channel of an integer type, or nullptr.
/// Vertices come in the order of their lowest corners; those without a face are left out.
RenderMesh make_render_mesh(const Connectivity& connectivity, std::span<const CornerKeys> split_by,
                            const Attribute* material);

/// Bytes that making it takes at most.
uint64_t render_mesh_memory(const Connectivity& connectivity);
/// Bytes that it takes.
uint64_t kept_memory(const RenderMesh& mesh);

}  // namespace reeb
