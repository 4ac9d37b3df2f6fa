// One frame in one file: OBJ, PLY, OFF or STL.
//
// Vertex order, vertex count, isolated and duplicate vertices, degenerate, repeated and
// non-manifold faces and polygons come through as the file has them; positions are the float32
// values nearest to what the file says. Readers take only what they understand to the last byte:
// anything else is an error, or is listed in `unkept` or `notes`. OpenMesh would drop or split
// faces that share an edge more than twice or are listed twice, so these readers are our own
// (tests/tools/io/openmesh_test.cpp shows it).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "tools/io/text_number.h"

namespace reeb::tools {

struct ObjFaces;

enum class MeshFormat { kObj, kPly, kOff, kStl };

/// By the extension, in any case.
std::optional<MeshFormat> mesh_format(const std::filesystem::path& path);

/// The extension in lower case, with its point.
std::string lower_extension(const std::filesystem::path& path);

/// An earlier frame. A frame with the same connectivity is read faster and does not keep it again.
struct MeshReference {
  Connectivity connectivity;
  std::string face_text =
      {};  ///< OBJ: everything from the first face on; empty where vertices follow
  std::shared_ptr<const ObjFaces> obj_faces = {};  ///< OBJ: what that text says
};

/// Something that a file has and a Sequence does not.
struct Unkept {
  std::string name;  ///< as in "only positions and faces are kept, not: NAME"
  uint64_t count = 0;

  bool operator==(const Unkept&) const = default;
};

struct MeshFrame {
  bool same_connectivity = false;  ///< as in the reference; then `connectivity` is empty
  Connectivity connectivity;
  std::vector<float> positions;       ///< [vertex][xyz], finite
  std::vector<float> remainders;      ///< see Real, [vertex][xyz]; empty where all are 0
  std::vector<Attribute> attributes;  ///< of the frame, static; of no elements: none
  std::string_view face_text;         ///< part of the bytes read, see MeshReference
  std::shared_ptr<const ObjFaces> obj_faces;
  std::vector<Unkept> unkept;
  std::vector<std::string> notes;  ///< sentences on what is odd but harmless

  void append_coordinate(const Real& x);
  /// Numbers of attribute `name` that are not finite become 0, which is noted.
  void zero_not_finite(const std::string& name, std::vector<float>& values);
};

/// Reads the bytes of a file. `reference` may be null. A failure's message says the place and the
/// remedy but not the file. Memory stays in proportion to the bytes, whatever counts they announce.
///
/// STL has no vertices, only corners: corners at exactly equal positions become one vertex, in the
/// order of their first appearance. Where the triangle count fits the reference and its corners
/// still agree, its vertices are taken instead, so that two vertices may meet for a frame.
Status read_mesh(std::string_view bytes, MeshFormat format, const MeshReference* reference,
                 MeshFrame& out);

/// The text or bytes of a file. PLY and STL are binary, little endian; floats in text are the
/// shortest that read back to the same value. STL gets polygons as fans of triangles. `attributes`:
/// of the frame, static; those that the format does not take go to `unkept`, if that is wanted.
std::string write_mesh(const Connectivity& connectivity, std::span<const float> positions,
                       MeshFormat format, std::span<const Attribute> attributes = {},
                       std::vector<std::string>* unkept = nullptr);

// The formats one by one; they leave the checks common to all to `read_mesh`.
Status read_obj(std::string_view bytes, const MeshReference* reference, MeshFrame& out);
Status read_ply(std::string_view bytes, MeshFrame& out);
Status read_off(std::string_view bytes, MeshFrame& out);
Status read_stl(std::string_view bytes, const MeshReference* reference, MeshFrame& out);

std::string write_obj(const Connectivity& connectivity, std::span<const float> positions,
                      std::span<const Attribute> attributes, std::vector<std::string>* unkept);

inline void MeshFrame::append_coordinate(const Real& x) {
  positions.push_back(x.value);
  if (x.remainder == 0) return;
  remainders.resize(positions.size());
  remainders.back() = x.remainder;
}

}  // namespace reeb::tools
