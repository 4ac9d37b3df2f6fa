#include "codec/dec/draco_connectivity.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include "bitstream/bytes.h"

namespace reeb {
namespace {

// What Draco reads first. It trusts the counts for its allocations.
Status check_counts(std::span<const uint8_t> middle, const Limits& limits, uint64_t max_triangles) {
  ByteReader in(middle);
  const uint8_t traversal = in.u8();
  const uint64_t vertices = in.varuint();
  const uint64_t triangles = in.varuint();
  const uint8_t attribute_tables = in.u8();
  const uint64_t symbols = in.varuint();
  const uint64_t splits = in.varuint();
  if (!in.ok()) return Status::corrupt("connectivity: its header is malformed");
  if (traversal != 0 && traversal != 2) return Status::corrupt("connectivity: unknown traversal");
  if (triangles > 4 * uint64_t{limits.max_faces} || vertices > 4 * uint64_t{limits.max_vertices} ||
      triangles > limits.max_memory / kDracoMemoryPerTriangle) {
    return Status::limit("connectivity: more triangles or vertices than allowed");
  }
  if (attribute_tables != 0 || triangles == 0 || vertices == 0 || vertices > 3 * triangles ||
      symbols > triangles || splits > symbols || triangles > max_triangles) {
    return Status::corrupt("connectivity: its counts are impossible");
  }
  return {};
}

bool read_triangles(const draco::Mesh& mesh, DracoMesh& out) {
  out.point_count = mesh.num_points();
  out.triangles.clear();
  out.triangles.reserve(size_t{mesh.num_faces()} * 3);
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(f)) {
      if (point.value() >= out.point_count) return false;
      out.triangles.push_back(point.value());
    }
  }
  return true;
}

}  // namespace

uint64_t draco_triangle_count(std::span<const uint8_t> middle) {
  ByteReader in(middle);
  in.u8();
  in.varuint();
  return in.varuint();
}

Status decode_draco_connectivity(std::span<const uint8_t> middle, const Limits& limits,
                                 uint64_t max_triangles, DracoMesh& out) {
  if (Status s = check_counts(middle, limits, max_triangles); !s.ok()) return s;
  std::vector<char> file(kDracoFront.begin(), kDracoFront.end());
  file.insert(file.end(), middle.begin(), middle.end());
  file.insert(file.end(), kDracoBack.begin(), kDracoBack.end());
  draco::DecoderBuffer buffer;
  buffer.Init(file.data(), file.size());
  draco::Mesh mesh;
  const draco::Status status = draco::Decoder().DecodeBufferToGeometry(&buffer, &mesh);
  if (!status.ok()) {
    return Status::corrupt(std::string("connectivity: Draco says ") + status.error_msg());
  }
  if (buffer.remaining_size() != 0 || !read_triangles(mesh, out)) {
    return Status::corrupt("connectivity: Draco's mesh is malformed");
  }
  return {};
}

}  // namespace reeb
