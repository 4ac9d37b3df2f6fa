#include "tests/codec/draco_reading.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include "codec/enc/reference/draco_connectivity_encoder.h"

namespace reeb::test {

bool read_by_draco(std::span<const uint8_t> section, PointTriangles& out) {
  std::vector<char> file(kDracoFront.begin(), kDracoFront.end());
  file.insert(file.end(), section.begin(), section.end());
  file.push_back(0);  // no attributes
  draco::DecoderBuffer buffer;
  buffer.Init(file.data(), file.size());
  draco::Mesh mesh;
  if (!draco::Decoder().DecodeBufferToGeometry(&buffer, &mesh).ok()) return false;
  if (buffer.remaining_size() != 0) return false;
  out.point_count = mesh.num_points();
  out.triangles.clear();
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(f)) out.triangles.push_back(point.value());
  }
  return true;
}

}  // namespace reeb::test
