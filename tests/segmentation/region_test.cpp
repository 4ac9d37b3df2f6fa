// Regions, patches and links on small grids.
#include <catch2/catch.hpp>
#include <set>

#include "segmentation/patches.h"
#include "segmentation/regions.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::segmentation;

namespace {

std::vector<uint32_t> label_columns(int cells, int border) {
  std::vector<uint32_t> labels;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) labels.push_back(i > border);
  }
  return labels;
}

}  // namespace

TEST_CASE("regions grow over the vertices without one") {
  const Surface square = shapes::surface_of(shapes::square(4, 4));
  std::vector<uint32_t> labels(25, kNone);
  labels[0] = 7;
  labels[24] = 3;
  grow_regions(square, labels);
  CHECK(labels[1] == 7);
  CHECK(labels[23] == 3);
  CHECK(std::count(labels.begin(), labels.end(), kNone) == 0);
}

TEST_CASE("fragments of a region go to the regions around") {
  const Surface square = shapes::surface_of(shapes::square(4, 4));
  std::vector<uint32_t> labels = label_columns(4, 2);
  labels[0] = 1;   // a lone vertex of region 1 in the far corner
  labels[24] = 0;  // and one of region 0
  keep_connected(square, labels, 2);
  CHECK(labels == label_columns(4, 2));
}

TEST_CASE("labels are renumbered by first appearance") {
  std::vector<uint32_t> labels = {9, 9, 4, 9, 0};
  CHECK(renumber(labels) == 3);
  CHECK(labels == std::vector<uint32_t>{0, 0, 1, 0, 2});
}

TEST_CASE("areas and the length of a straight border") {
  const Surface square = shapes::surface_of(shapes::square(4, 4));
  const std::vector<uint32_t> labels = label_columns(4, 1);
  std::vector<double> areas(2, 0);
  add_region_areas(square, labels, areas);
  CHECK(areas[0] + areas[1] == Approx(16));
  CHECK(areas[0] == Approx(6));  // the border runs at x = 1.5
  const auto links = border_links(square, labels);
  REQUIRE(links.size() == 1);
  CHECK((links[0].a == 0 && links[0].b == 1));
  CHECK(links[0].border == Approx(4));
}

TEST_CASE("gaps are bridged by a shortest tree") {
  // Four single vertices on a line; 0 and 1 are linked already.
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 4, 0, 0, 9, 0, 0};
  const auto gaps = gap_links(positions, {0, 1, 2, 3}, {{0, 1, 1.0, 0}});
  REQUIRE(gaps.size() == 2);
  CHECK((gaps[0].a == 1 && gaps[0].b == 2 && gaps[0].gap == 3));
  CHECK((gaps[1].a == 2 && gaps[1].b == 3 && gaps[1].gap == 5));
  CHECK(gap_links({}, {}, {}).empty());
}

TEST_CASE("vertices without a label take that of the nearest") {
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 4, 0, 0, 9, 0, 0};
  std::vector<uint32_t> labels = {5, kNone, kNone, 6};
  std::vector<double> values = {0.5, 0, 0, 0.75};
  CHECK(label_by_nearest(positions, labels, values) == 2);
  CHECK(labels == std::vector<uint32_t>{5, 5, 5, 6});
  CHECK(values[2] == 0.5);
}

TEST_CASE("patches lie within their regions, are connected and of about one size") {
  const Surface square = shapes::surface_of(shapes::square(19, 19));
  const std::vector<uint32_t> labels = label_columns(19, 7);
  uint32_t count = 10;
  std::vector<uint32_t> patches = cut_patches(square, labels, 20, count);
  REQUIRE(count == 10 + 8 + 12);
  std::vector<uint32_t> size(count, 0), region(count, kNone);
  for (uint32_t v = 0; v < patches.size(); ++v) {
    REQUIRE((patches[v] >= 10 && patches[v] < count));
    ++size[patches[v]];
    if (region[patches[v]] == kNone) region[patches[v]] = labels[v];
    CHECK(region[patches[v]] == labels[v]);
  }
  for (uint32_t p = 10; p < count; ++p) CHECK((size[p] >= 5 && size[p] <= 60));
  std::vector<uint32_t> connected = patches;
  keep_connected(square, connected, count);
  CHECK(connected == patches);
}
