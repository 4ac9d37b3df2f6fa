// A shot's reference mesh as the encoder works with it: what the decoder will have, and the way
// back to the input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/headers.h"
#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "codec/common/fast/surface.h"
#include "codec/common/reference/reference_mesh.h"
#include "codec/enc/reference/reference_mesh_encoder.h"

namespace reeb {

struct SurfaceContext {
  ReferenceHeader header;          ///< grid of the reference mesh
  std::vector<uint8_t> bytes;      ///< coded reference mesh
  ReferenceMesh mesh;              ///< as decoded; its grid is in `surface`
  std::vector<uint32_t> input_of;  ///< vertex of `mesh` (coding numbering) -> vertex of the input
  Surface surface;                 ///< of the decoded mesh
  std::vector<uint32_t> input;     ///< row of the surface graph -> vertex of the input
  std::vector<uint32_t> row_of;    ///< vertex of the input -> row

  uint32_t rows() const { return static_cast<uint32_t>(input.size()); }
};

/// Bounding box of positions, xyz of at least one vertex.
struct Bounds {
  float low[3];
  double side;  ///< longest
};
Bounds bounds_of(std::span<const float> xyz);

/// Codes the shot's first frame on a grid of `bits` (1 .. 16) bits along the longest side of its
/// bounding box.
/// `plan` is of the shot's connectivity.
Status make_surface_context(const Shot& shot, ReferencePlan& plan, uint32_t bits,
                            const ReferenceOptions& options, SurfaceContext& out);

}  // namespace reeb
