// draco_triangles FILE: prints the number of points of a Draco mesh, then the three points of every
// triangle, a triangle a line, as Draco's decoder numbers them. For decoders that leave Draco's
// connectivity to a command; it uses nothing of Reeb.
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: draco_triangles FILE\n", stderr);
    return 2;
  }
  std::ifstream in(argv[1], std::ios::binary);
  const std::vector<char> file((std::istreambuf_iterator<char>(in)), {});
  draco::DecoderBuffer buffer;
  buffer.Init(file.data(), file.size());
  draco::Mesh mesh;
  const draco::Status status = draco::Decoder().DecodeBufferToGeometry(&buffer, &mesh);
  if (!status.ok() || buffer.remaining_size() != 0) {
    std::fprintf(stderr, "draco_triangles: %s\n",
                 status.ok() ? "bytes are left" : status.error_msg());
    return 1;
  }
  std::printf("%u\n", mesh.num_points());
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(f);
    std::printf("%u %u %u\n", face[0].value(), face[1].value(), face[2].value());
  }
  return 0;
}
