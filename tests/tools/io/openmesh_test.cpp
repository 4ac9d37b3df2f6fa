// OpenMesh as a witness: on plain meshes our readers agree with it to the bit; on odd ones it
// changes what the file says, which is why the readers are our own.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "tests/tools/temp_folder.h"
#include "tests/tools/test_meshes.h"
#include "tools/io/file_bytes.h"
#include "tools/io/mesh_file.h"

namespace reeb::tools {
namespace {

using OpenMeshMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

TestMesh read_by_openmesh(const std::string& path) {
  OpenMeshMesh mesh;
  TestMesh out;
  // Its complaints about complex edges belong to what is shown here.
  omerr().disable();
  REQUIRE(OpenMesh::IO::read_mesh(mesh, path));
  omerr().enable();
  out.connectivity.vertex_count = static_cast<uint32_t>(mesh.n_vertices());
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    out.positions.insert(out.positions.end(), {p[0], p[1], p[2]});
  }
  for (const auto face : mesh.faces()) {
    uint32_t size = 0;
    for (const auto vertex : mesh.fv_range(face)) {
      out.connectivity.corners.push_back(static_cast<uint32_t>(vertex.idx()));
      ++size;
    }
    out.connectivity.face_sizes.push_back(size);
  }
  return out;
}

/// Each face from its smallest vertex on: OpenMesh chooses the first corner freely.
std::vector<std::vector<uint32_t>> normalized_faces(const Connectivity& c) {
  std::vector<std::vector<uint32_t>> faces;
  auto corner = c.corners.begin();
  for (const uint32_t size : c.face_sizes) {
    std::vector<uint32_t> face(corner, corner + size);
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    faces.push_back(face);
    corner += size;
  }
  return faces;
}

bool keeps(const TestMesh& mesh, const TestMesh& back) {
  return back.positions == mesh.positions &&
         normalized_faces(back.connectivity) == normalized_faces(mesh.connectivity);
}

const std::map<MeshFormat, std::string> kExtensions{{MeshFormat::kObj, ".obj"},
                                                    {MeshFormat::kPly, ".ply"},
                                                    {MeshFormat::kOff, ".off"},
                                                    {MeshFormat::kStl, ".stl"}};

}  // namespace

TEST_CASE("our readers and OpenMesh agree on a manifold mesh") {
  // A grid with coordinates that need all digits of float32.
  TestMesh mesh{"grid", {}, {}};
  constexpr uint32_t kSide = 12;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const auto x = static_cast<float>(i % kSide);
    const auto y = static_cast<float>(i / kSide);
    mesh.positions.insert(mesh.positions.end(), {x / 3, y / 7, x * y / 1.1f});
  }
  mesh.connectivity.vertex_count = kSide * kSide;
  for (uint32_t i = 0; i + 1 < kSide; ++i) {
    for (uint32_t j = 0; j + 1 < kSide; ++j) {
      const uint32_t v = i * kSide + j;
      mesh.connectivity.face_sizes.push_back(4);
      for (const uint32_t corner : {v, v + 1, v + kSide + 1, v + kSide}) {
        mesh.connectivity.corners.push_back(corner);
      }
    }
  }
  const TempFolder folder;
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kOff}) {
    const std::string bytes = write_mesh(mesh.connectivity, mesh.positions, format);
    const std::string path = folder.write("m" + kExtensions.at(format), bytes);
    MeshFrame ours;
    REQUIRE(read_mesh(bytes, format, nullptr, ours).ok());
    const TestMesh theirs = read_by_openmesh(path);
    INFO(path);
    CHECK(theirs.positions == ours.positions);
    CHECK(normalized_faces(theirs.connectivity) == normalized_faces(ours.connectivity));
  }
}

TEST_CASE("OpenMesh does not keep odd meshes, whatever the format") {
  const TempFolder folder;
  for (const MeshFormat format : {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kOff}) {
    std::set<std::string> lost;
    for (const TestMesh& mesh : odd_meshes()) {
      const std::string bytes = write_mesh(mesh.connectivity, mesh.positions, format);
      const TestMesh back = read_by_openmesh(folder.write("m" + kExtensions.at(format), bytes));
      if (!keeps(mesh, back)) lost.insert(mesh.name);
    }
    INFO(kExtensions.at(format));
    CHECK(lost.count("three faces at an edge") == 1);
    CHECK(lost.count("a face listed twice") == 1);
    CHECK(lost.count("degenerate faces") == 1);
    CHECK(lost.count("faces of opposite sense") == 1);
    CHECK(lost.count("isolated vertices") == 0);
    CHECK(lost.count("polygons") == 0);
  }
}

}  // namespace reeb::tools
