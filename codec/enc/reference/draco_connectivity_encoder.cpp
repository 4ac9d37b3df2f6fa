#include "codec/enc/reference/draco_connectivity_encoder.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <limits>

namespace reeb {
namespace {

using Bytes = std::vector<uint8_t>;

// A Draco file of the triangles with positions (x, 0, 0), x the vertex number or 0.
bool encode_file(std::span<const uint32_t> triangles, uint32_t vertex_count, bool numbered,
                 Bytes& file) {
  draco::Mesh mesh;
  mesh.set_num_points(vertex_count);
  draco::GeometryAttribute position;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false, 12, 0);
  const int id = mesh.AddAttribute(position, true, vertex_count);
  for (uint32_t v = 0; v < vertex_count; ++v) {
    const int32_t xyz[3] = {numbered ? static_cast<int32_t>(v) : 0, 0, 0};
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), xyz);
  }
  mesh.SetNumFaces(triangles.size() / 3);
  for (uint32_t t = 0; t < triangles.size() / 3; ++t) {
    const uint32_t* v = &triangles[size_t{t} * 3];
    mesh.SetFace(draco::FaceIndex(t),
                 {draco::PointIndex(v[0]), draco::PointIndex(v[1]), draco::PointIndex(v[2])});
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(0, 0);
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  if (!encoder.SetAttributePredictionScheme(id, draco::PREDICTION_NONE).ok()) return false;
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) return false;
  file.assign(buffer.data(), buffer.data() + buffer.size());
  return true;
}

// Cuts the constant front off, and the positions; false where they are not what they should be.
bool cut_ends(const Bytes& file, Bytes& section) {
  constexpr std::array<uint8_t, 20> kPositions = {1, 0xFF, 0, 1, 1, 0, 5, 3,    0, 0,
                                                  1, 0xFE, 1, 1, 3, 1, 1, 0x40, 1, 0};
  if (file.size() < kDracoFront.size() + kPositions.size()) return false;
  const auto begin = file.begin() + kDracoFront.size();
  const auto end = file.end() - kPositions.size();
  section.assign(begin, end);
  return std::equal(kDracoFront.begin(), kDracoFront.end(), file.begin()) &&
         std::equal(kPositions.begin(), kPositions.end(), end);
}

// The vertex numbers that the positions of a decoded file hold, by point.
bool read_vertex_numbers(const Bytes& file, std::vector<uint32_t>& vertex_of) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(file.data()), file.size());
  draco::Mesh mesh;
  if (!draco::Decoder().DecodeBufferToGeometry(&buffer, &mesh).ok()) return false;
  const auto* position = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (position == nullptr) return false;
  vertex_of.resize(mesh.num_points());
  for (uint32_t p = 0; p < vertex_of.size(); ++p) {
    int32_t xyz[3];
    position->GetMappedValue(draco::PointIndex(p), xyz);
    vertex_of[p] = static_cast<uint32_t>(xyz[0]);
  }
  return true;
}

}  // namespace

// The numbering of points depends on connectivity alone, so a second file whose positions are
// vertex numbers tells which point is which vertex.
bool encode_draco_connectivity(std::span<const uint32_t> triangles, uint32_t vertex_count,
                               DracoEncoding& out) {
  if (vertex_count > static_cast<uint32_t>(std::numeric_limits<int32_t>::max())) return false;
  Bytes plain, numbered;
  if (!encode_file(triangles, vertex_count, false, plain) ||
      !encode_file(triangles, vertex_count, true, numbered) || !cut_ends(plain, out.section)) {
    return false;
  }
  constexpr uint32_t kAny = std::numeric_limits<uint32_t>::max();
  const Limits limits = {kAny, kAny, kAny, std::numeric_limits<uint64_t>::max()};
  return decode_connectivity(out.section, limits, kAny, out.mesh).ok() &&
         read_vertex_numbers(numbered, out.vertex_of) &&
         out.vertex_of.size() == out.mesh.point_count;
}

}  // namespace reeb
