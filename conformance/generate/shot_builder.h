// Puts streams together from the syntax structures: sections whose every value is chosen.
#pragma once

#include <functional>
#include <random>
#include <span>
#include <vector>

#include "bitstream/container.h"
#include "codec/common/base/sequence.h"
#include "codec/common/fast/surface.h"
#include "codec/common/fields/field.h"
#include "codec/common/motion/motion_model.h"
#include "codec/common/synthesis/corrections.h"
#include "codec/enc/reference/reference_mesh_encoder.h"
#include "conformance/generate/stream.h"

namespace reeb::conformance {

/// Residual of a component and row; made representable before it is coded.
using Residuals = std::function<int64_t(uint32_t component, uint32_t row)>;

/// A coded mesh and what its groups need to know of it.
struct BuiltMesh {
  Bytes bytes;
  Surface surface;

  uint32_t rows() const { return surface.rows(); }
};

/// Grid positions in input order, [vertex][xyz].
BuiltMesh build_mesh(const Connectivity& connectivity, std::span<const int32_t> grid,
                     const ReferenceOptions& options = {});
/// The same with every face listed, none left to Draco; its order kept if wanted.
BuiltMesh build_listed_mesh(const Connectivity& connectivity, std::span<const int32_t> grid,
                            bool order_kept = false);
/// The mesh with other bytes for its section *faces*, which is there; without that for the order of
/// its vertices if wanted.
BuiltMesh with_face_section(const BuiltMesh& mesh, const Bytes& faces, bool order_dropped = false);

/// A group; its sections are made from the choices, unless they are there already.
struct BuiltGroup {
  GroupHeader header;
  Residuals coefficients;
  Residuals basis;
  std::function<RegionBinding(uint32_t row)> binding;
  std::function<MotionModel::Transform(uint32_t component, uint32_t region)> transform;
  std::function<Correction(uint32_t row, uint32_t t, uint32_t axis)> correction;
  Bytes motion_section, coefficient_section, basis_section, correction_section;
};

/// Takes the bytes for the group's correction section, and counts the corrections that they are;
/// false where they are no sound section.
bool set_correction_section(const BuiltMesh& mesh, BuiltGroup& group, Bytes bytes);

/// Makes the sections that are not there.
void build_sections(const BuiltMesh& mesh, BuiltGroup& group);

/// A file, chunk by chunk; ends the program where the writer refuses.
class FileBuilder {
 public:
  explicit FileBuilder(const SequenceHeader& header);
  void reference(const ReferenceHeader& header, const BuiltMesh& mesh);
  void group(const BuiltMesh& mesh, BuiltGroup group);
  void metadata(const std::vector<MetadataEntry>& entries);
  void chunk(const char* type, const Bytes& payload);
  Bytes finish();

 private:
  Bytes bytes_;
  ContainerWriter writer_{bytes_};
};

/// One shot of one group from its first frame on, grid step 1, origin 0.
Bytes build_file(const BuiltMesh& mesh, const BuiltGroup& group);

Bytes random_bytes(uint32_t seed, size_t count);

}  // namespace reeb::conformance
