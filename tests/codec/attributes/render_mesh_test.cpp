#include "codec/dec/attributes/render_mesh.h"

#include <catch2/catch.hpp>

#include "tests/codec/attributes/samples.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

TEST_CASE("render vertices are combinations of vertex and corner values", "[attributes]") {
  // Two quadrilaterals that share the edge 1-2; at vertex 2 their texture coordinates differ.
  Shape shape;
  for (int i = 0; i < 7; ++i) shape.add_vertex(static_cast<float>(i), 0, 0);
  shape.add_face({0, 1, 2, 3});
  shape.add_face({1, 4, 5, 2});
  shape.add_face({6, 6});
  const Connectivity& c = shape.connectivity;
  const Attribute uv = make("vt", Domain::kCorner, ValueType::kU8, 2,
                            std::vector<uint8_t>{0, 0, 1, 0, 1, 1, 0, 1,  //
                                                 1, 0, 2, 0, 2, 1, 1, 9, 0, 0, 0, 0});
  const Attribute material =
      make("usemtl", Domain::kFace, ValueType::kU16, 1, std::vector<uint16_t>{5, 2, 9});
  const CornerKeys split[] = {{uv.values.data(), uv.element_bytes()}};
  const RenderMesh mesh = make_render_mesh(c, split, &material);
  CHECK(mesh.source_vertex == std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 2, 6});
  CHECK(mesh.source_corner == std::vector<uint32_t>{0, 1, 2, 3, 5, 6, 7, 8});
  CHECK(mesh.triangles == std::vector<uint32_t>{1, 4, 5, 1, 5, 6, 0, 1, 2, 0, 2, 3});
  CHECK(mesh.source_face == std::vector<uint32_t>{1, 1, 0, 0});
  REQUIRE(mesh.ranges.size() == 2);
  CHECK(mesh.ranges[0].material == 2);
  CHECK(mesh.ranges[0].first == 0);
  CHECK(mesh.ranges[0].count == 2);
  CHECK(mesh.ranges[1].material == 5);
  CHECK(mesh.ranges[1].first == 2);
  CHECK(mesh.ranges[1].count == 2);

  const RenderMesh plain = make_render_mesh(c, {}, nullptr);
  CHECK(plain.source_vertex == std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6});
  CHECK(plain.triangles == std::vector<uint32_t>{0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2});
  REQUIRE(plain.ranges.size() == 1);
  CHECK(plain.ranges[0].count == 4);
}
