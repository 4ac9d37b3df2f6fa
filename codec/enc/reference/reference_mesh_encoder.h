// Encoder of the reference mesh of a shot.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/reference/reference_mesh.h"

namespace reeb {

struct ReferenceOptions {
  bool reorder = false;     ///< drop the vertex order of the input
  bool face_order = false;  ///< keep the order and first corners of the faces; not with `reorder`
  bool plain = false;       ///< quick to decode, as only the fast profile has it
};

struct DracoPlan;

/// What coding a connectivity takes and no position changes: made once, used for many grids.
class ReferencePlan {
 public:
  /// `connectivity` must outlive the plan. Nothing is checked before `encode_reference`.
  explicit ReferencePlan(const Connectivity& connectivity);
  ~ReferencePlan();
  const Connectivity& connectivity() const { return connectivity_; }
  /// Computed when first asked for; the connectivity must be a valid one.
  const DracoPlan& draco();
  /// Input vertex of each coding vertex; these are the vertices of a file that drops their order.
  std::vector<uint32_t> input_vertices();

 private:
  const Connectivity& connectivity_;
  std::unique_ptr<DracoPlan> draco_;
};

/// Encodes any connectivity whose corners are below its vertex count (1 .. 2^30 vertices, at most
/// 2^30 corners), with grid positions 0 .. kGridMax, [vertex][xyz] in input order. Every face comes
/// back, unless `face_order` is set up to the order of faces and the first corner of each.
/// `decoded` is what the decoder makes of `bytes`, compared with the input; `input_index` is
/// `plan.input_vertices()`.
Status encode_reference(ReferencePlan& plan, std::span<const int32_t> grid,
                        const ReferenceOptions& options, std::vector<uint8_t>& bytes,
                        ReferenceMesh& decoded, std::vector<uint32_t>& input_index);

/// The same with a plan for this grid alone.
Status encode_reference(const Connectivity& connectivity, std::span<const int32_t> grid,
                        const ReferenceOptions& options, std::vector<uint8_t>& bytes,
                        ReferenceMesh& decoded, std::vector<uint32_t>& input_index);

}  // namespace reeb
