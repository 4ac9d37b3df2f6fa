#include <png.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <set>

#include "tests/tools/test_meshes.h"
#include "tools/picture/contact_sheet.h"
#include "tools/picture/image.h"
#include "tools/picture/render.h"

namespace reeb::tools {
namespace {

constexpr Colour kWhite{255, 255, 255};

size_t count_drawn(const Image& image) {
  return image.pixels.size() -
         static_cast<size_t>(std::count(image.pixels.begin(), image.pixels.end(), kWhite));
}

const Camera kFront = Camera::orbit(0, 0, false);

}  // namespace

TEST_CASE("a PNG reads back to the same pixels") {
  Image image(7, 3);
  for (int i = 0; i < 21; ++i) {
    image.pixels[static_cast<size_t>(i)] = {static_cast<uint8_t>(i), static_cast<uint8_t>(9 * i),
                                            200};
  }
  std::string bytes;
  REQUIRE(encode_png(image, bytes).ok());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  REQUIRE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) != 0);
  CHECK(png.width == 7);
  CHECK(png.height == 3);
  png.format = PNG_FORMAT_RGB;
  std::vector<Colour> pixels(21);
  REQUIRE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr) != 0);
  CHECK(pixels == image.pixels);
}

TEST_CASE("shrinking averages") {
  Image tile(4, 2, {0, 0, 0});
  tile.at(0, 0) = {100, 40, 8};
  tile.at(3, 1) = {200, 0, 0};
  Image out(4, 4);
  paste_shrunk(tile, 2, 1, 2, out);
  CHECK(out.at(1, 2) == Colour{25, 10, 2});
  CHECK(out.at(2, 2) == Colour{50, 0, 0});
  CHECK(count_drawn(out) == 2);
}

TEST_CASE("text has its ink where its letters are, and stays inside") {
  Image image(40, kTextHeight);
  draw_text("l", 10, 0, {0, 0, 0}, image);
  const auto ink = [&](int x, int y) { return image.at(x, y)[0] < 128; };
  // A stem on the baseline: narrow, taller than wide, beside the pen.
  std::set<int> columns;
  std::set<int> rows;
  for (int i = 0; i < 40 * kTextHeight; ++i) {
    if (ink(i % 40, i / 40)) columns.insert(i % 40), rows.insert(i / 40);
  }
  REQUIRE_FALSE(rows.empty());
  CHECK(columns.size() <= 2);
  CHECK(rows.size() >= 9);
  CHECK(*columns.begin() >= 10);
  CHECK(*columns.begin() < 10 + text_width("l"));
  Image small(3, 3);
  draw_text("WWWW", -2, -2, {0, 0, 0}, small);
  CHECK(small.pixels.size() == 9);
  CHECK(text_width("mm") > 2 * text_width("i"));
  CHECK(text_width("\xc3") == text_width("?"));
}

TEST_CASE("lines cover a stadium, discs a circle") {
  Image image(100, 60);
  draw_line({30, 30}, {70, 30}, 10, {0, 0, 0}, image);
  CHECK(static_cast<double>(count_drawn(image)) == Approx(800 + 314.2).epsilon(0.01));
  CHECK(image.at(50, 21) == Colour{0, 0, 0});
  CHECK(image.at(50, 18) == kWhite);
  Image disc(40, 40);
  draw_line({20, 20}, {20, 20}, 15, {0, 0, 0}, disc);
  CHECK(static_cast<double>(count_drawn(disc)) == Approx(706.9).epsilon(0.02));
  draw_line({-50, -50}, {90, 300}, 9, {9, 0, 0}, disc);  // clipped
}

TEST_CASE("frames are spread from the first to the last") {
  CHECK(spread_frames(100, 4) == std::vector<uint32_t>{0, 33, 66, 99});
  CHECK(spread_frames(2, 4) == std::vector<uint32_t>{0, 1});
  CHECK(spread_frames(5, 1) == std::vector<uint32_t>{0});
}

TEST_CASE("cameras look along the axes they say") {
  const auto is = [](const Vec3& a, const Vec3& b) { return length(a - b) < 1e-12; };
  CHECK((is(kFront.right, {1, 0, 0}) && is(kFront.up, {0, 1, 0}) && is(kFront.back, {0, 0, 1})));
  const Camera side = Camera::orbit(90, 0, false);
  CHECK((is(side.back, {1, 0, 0}) && is(side.up, {0, 1, 0}) && is(side.right, {0, 0, -1})));
  const Camera above = Camera::orbit(0, 90, false);
  CHECK((is(above.back, {0, 1, 0}) && is(above.up, {0, 0, -1})));
  const Camera z_up = Camera::orbit(0, 0, true);
  CHECK((is(z_up.up, {0, 0, 1}) && is(z_up.back, {0, -1, 0}) && is(z_up.right, {1, 0, 0})));
}

TEST_CASE("a square covers its pixels, once") {
  const TestMesh quad = test_mesh("quad", {0, 0, 0, 10, 0, 0, 10, 10, 0, 0, 10, 0}, {{0, 1, 2, 3}});
  Image image(40, 40);
  const Colour red{200, 0, 0};
  draw_mesh(quad.connectivity, quad.positions, {&red, 1}, kFront, {{5, 5, 0}, 2}, image);
  CHECK(count_drawn(image) == 400);
  CHECK(image.at(10, 10) != kWhite);
  CHECK(image.at(29, 29) != kWhite);
  CHECK(image.at(9, 20) == kWhite);
  CHECK(image.at(20, 30) == kWhite);
  CHECK(image.at(20, 20)[1] == 0);
}

TEST_CASE("the nearer face is seen, whatever the order, and outside is cut off") {
  const std::vector<float> p{-9, -9, 0, 9, -9, 0, 0, 9, 0, -9, -9, 1, 9, -9, 1, 0, 9, 1};
  const std::vector<Colour> colours{{0, 0, 250}, {0, 0, 250}, {0, 0, 250},
                                    {250, 0, 0}, {250, 0, 0}, {250, 0, 0}};
  for (const TestMesh& mesh :
       {test_mesh("a", p, {{0, 1, 2}, {3, 4, 5}}), test_mesh("b", p, {{3, 5, 4}, {0, 1, 2}})}) {
    Image image(8, 8);
    draw_mesh(mesh.connectivity, mesh.positions, colours, kFront, {{0, 0, 0}, 4}, image);
    CHECK(image.at(4, 5)[0] > 0);
    CHECK(image.at(4, 5)[2] == 0);
    Image from_behind(8, 8);
    draw_mesh(mesh.connectivity, mesh.positions, colours, Camera::orbit(180, 0, false),
              {{0, 0, 0}, 4}, from_behind);
    CHECK(from_behind.at(4, 5)[0] == 0);
    CHECK(from_behind.at(4, 5)[2] > 0);
  }
}

TEST_CASE("faces that meet at a right angle keep their edge, nearly flat ones do not") {
  // A roof over the line x = 0, seen from above; light comes from the left.
  const auto shades = [](float slope) {
    const TestMesh roof = test_mesh("roof",
                                    {-10, -10, -10 * slope, 0, -10, 0, 0, 10, 0, -10, 10,
                                     -10 * slope, 10, -10, -10 * slope, 10, 10, -10 * slope},
                                    {{0, 1, 2, 3}, {1, 4, 5, 2}});
    Image image(20, 20);
    const Colour grey{200, 200, 200};
    draw_mesh(roof.connectivity, roof.positions, {&grey, 1}, kFront, {{0, 0, 0}, 1}, image);
    std::set<uint8_t> values;
    for (const Colour& c : image.pixels) values.insert(c[0]);
    return values.size();
  };
  CHECK(shades(1.0f) == 2);
  CHECK(shades(0.2f) > 4);
}

TEST_CASE("a polygon of many corners covers its disc, about as fast as as many triangles") {
  constexpr uint32_t kCorners = 20000;
  std::vector<float> rim;
  std::vector<uint32_t> whole;
  std::vector<std::vector<uint32_t>> hub;  // triangles around one vertex
  for (uint32_t i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / kCorners;
    rim.insert(rim.end(),
               {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
    whole.push_back(i);
    if (i > 1) hub.push_back({0, i - 1, i});
  }
  const Colour red{200, 0, 0};
  for (const auto& faces : {std::vector<std::vector<uint32_t>>{whole}, hub}) {
    const TestMesh disc = test_mesh("disc", rim, faces);
    Image image(600, 600);
    const auto start = std::chrono::steady_clock::now();
    draw_mesh(disc.connectivity, disc.positions, {&red, 1}, kFront, {{0, 0, 0}, 250}, image);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(static_cast<double>(count_drawn(image)) ==
          Approx(250 * 250 * std::acos(-1.0)).epsilon(0.01));
    CHECK(seconds.count() < 5);  // quadratic work takes many times that
  }
}

TEST_CASE("degenerate and isolated parts draw nothing") {
  const TestMesh mesh =
      test_mesh("bad", {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1, 0}, {{0, 0, 1}, {0, 1, 2}, {3}, {0, 3}});
  Image image(8, 8);
  const Colour red{200, 0, 0};
  draw_mesh(mesh.connectivity, mesh.positions, {&red, 1}, kFront, {{1, 0, 0}, 2}, image);
  CHECK(count_drawn(image) == 0);
}

TEST_CASE("the colours of errors") {
  CHECK(error_colour(0) == error_colour(-1));
  CHECK(error_colour(1) == error_colour(7));
  CHECK(error_colour(0)[2] > error_colour(0)[0]);
  CHECK(error_colour(1)[0] > error_colour(1)[2]);
}

TEST_CASE("a sheet has a column for each frame and three rows for a comparison") {
  Sequence a;
  const TestMesh mesh = plain_mesh();
  Shot& shot = a.shots.emplace_back();
  shot.connectivity = mesh.connectivity;
  shot.frame_count = 2;
  for (int t = 0; t < 2; ++t) {
    shot.positions.insert(shot.positions.end(), mesh.positions.begin(), mesh.positions.end());
  }
  Sequence b = a;
  b.shots[0].positions[14] += 0.5f;
  SheetOptions options;
  options.frames = {0, 1, 1};
  options.tile_width = 90;
  options.tile_height = 60;
  options.camera = kFront;
  const Image one = contact_sheet(a, nullptr, options);
  CHECK(one.width == 270);
  CHECK(one.height < 2 * 60);
  const Image three = contact_sheet(a, &b, options);
  CHECK(three.width == 270);
  CHECK(three.height > 3 * 60);
  // Red shows only where frame 2 differs.
  const auto reds = [&](int left) {
    int count = 0;
    for (int y = three.height - 60; y < three.height; ++y) {
      for (int x = left; x < left + 90; ++x) {
        if (three.at(x, y)[0] > 100 && three.at(x, y)[2] < 60) ++count;
      }
    }
    return count;
  };
  CHECK(reds(0) == 0);
  CHECK(reds(90) > 0);
  CHECK(reds(180) == reds(90));
}

}  // namespace reeb::tools
