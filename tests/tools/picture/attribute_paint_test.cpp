#include "tools/picture/attribute_paint.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tools/io/attribute_values.h"
#include "tools/picture/render.h"

namespace reeb::tools {
namespace {

Shot triangle_with(Attribute attribute) {
  return {{3, {3}, {0, 1, 2}}, 1, std::vector<float>(9), {std::move(attribute)}};
}

Attribute at_vertices_of_triangle(Semantic semantic, uint32_t channels,
                                  const std::vector<float>& values) {
  return make_attribute("a", semantic, Domain::kVertex, ValueType::kBinary32, channels, values);
}

}  // namespace

TEST_CASE("what is no number is painted as 0") {
  const Shot colours = triangle_with(at_vertices_of_triangle(
      Semantic::kColour, 3, {NAN, 1, 0, INFINITY, -INFINITY, 0.5f, 0, 0, 0}));
  CHECK(paint_corners(colours, 0, "a", {}) ==
        std::vector<Colour>{{0, 255, 0}, {255, 0, 127}, {0, 0, 0}});
  const Shot heat = triangle_with(at_vertices_of_triangle(Semantic::kGeneric, 1, {NAN, 0, 1}));
  CHECK(paint_corners(heat, 0, "a", {0, 1, true}) ==
        std::vector<Colour>{error_colour(0), error_colour(0), error_colour(1)});
}

TEST_CASE("places in a texture that are no numbers are 0") {
  const Shot shot = triangle_with(at_vertices_of_triangle(Semantic::kTextureCoordinate, 2,
                                                          {NAN, 0.25f, INFINITY, -INFINITY, 1, 2}));
  CHECK(texture_coordinates(shot, 0) == std::vector<float>{0, 0.25f, 0, 0, 1, 2});
}

}  // namespace reeb::tools
