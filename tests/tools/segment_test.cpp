#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tools/io/mesh_file.h"
#include "tools/sample/sample.h"
#include "tools/segment_files.h"
#include "tools/segment_picture.h"

namespace reeb::tools {
namespace {

/// The walking creature, segmented.
struct Creature {
  Sequence sequence = make_creature(2);
  const Shot& shot = sequence.shots[0];
  segmentation::Result result = segmentation::segment(shot.frame(0), shot.connectivity.corners);
  segmentation::Skeleton skeleton{result, shot.frame(0), shot.connectivity.corners};
};

size_t lines_starting(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += line.starts_with(start);
  return count;
}

}  // namespace

TEST_CASE("region colours are colours, and those of few regions differ") {
  std::set<std::array<double, 3>> seen;
  for (uint32_t r = 0; r < 200; ++r) {
    const auto colour = region_colour(r);
    for (const double part : colour) CHECK((part >= 0 && part <= 1));
    if (r < 50) CHECK(seen.insert(colour).second);
  }
}

TEST_CASE("the coloured PLY is the mesh") {
  const Creature c;
  const std::string ply = coloured_ply(c.shot.connectivity, c.shot.frame(0), c.result.labels);
  MeshFrame frame;
  REQUIRE(read_mesh(ply, MeshFormat::kPly, nullptr, frame).ok());
  CHECK(frame.connectivity == c.shot.connectivity);
  CHECK(std::equal(frame.positions.begin(), frame.positions.end(), c.shot.frame(0).begin(),
                   c.shot.frame(0).end()));
}

TEST_CASE("the graph as OBJ has a line per arc between existing vertices") {
  const Creature c;
  const auto pose = c.skeleton.place(c.shot.frame(0));
  const std::string obj = graph_obj(c.result.graph, pose);
  size_t points = pose.nodes.size();
  for (const auto& arc : pose.arcs) points += arc.size();
  CHECK(lines_starting(obj, "v ") == points);
  CHECK(lines_starting(obj, "l ") == c.result.graph.arcs.size());
}

TEST_CASE("the graph as JSON holds nodes, arcs, regions and a pose per frame") {
  const Creature c;
  const std::string text =
      graph_json(c.result, {c.skeleton.place(c.shot.frame(0)), c.skeleton.place(c.shot.frame(1))});
  const auto json = nlohmann::json::parse(text);
  CHECK(json["loops"] == 0);
  CHECK(json["components"] == 1);
  CHECK(json["nodes"].size() == c.result.graph.nodes.size());
  CHECK(json["extremities"].size() == c.result.feature_points.size());
  REQUIRE(json["frames"].size() == 2);
  CHECK(json["frames"][1]["nodes"].size() == json["nodes"].size());
  size_t vertices = 0;
  for (const auto& region : json["regions"]) vertices += region["vertices"].get<size_t>();
  CHECK(vertices == c.shot.connectivity.vertex_count);
  for (const auto& arc : json["arcs"]) {
    CHECK(arc["from"] < json["nodes"].size());
    CHECK(arc["region"] < json["regions"].size());
  }
}

TEST_CASE("a picture has a tile for each frame, with the regions' colours and the graph") {
  const Creature c;
  const PictureSubject subject{&c.shot.connectivity, c.result.labels, &c.result.graph};
  std::vector<PictureFrame> frames;
  for (uint32_t t = 0; t < 2; ++t) {
    frames.push_back({t, c.shot.frame(t), c.skeleton.place(c.shot.frame(t))});
  }
  const Image image = segment_picture(subject, frames, Camera::orbit(35, 12, false), 300);
  CHECK(image.width == 600);
  for (const int left : {0, 300}) {
    size_t coloured = 0;
    size_t dark = 0;
    for (int y = 30; y < image.height; ++y) {  // below the words
      for (int x = left; x < left + 300; ++x) {
        const auto [low, high] =
            std::minmax({image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]});
        coloured += high - low > 40;
        dark += high < 90;
      }
    }
    CHECK(coloured > 8000);
    CHECK(dark > 300);
  }
}

TEST_CASE("a picture of a mesh without extent, or of none, has a size") {
  const std::vector<float> positions(9, 1.0f);
  const std::vector<uint32_t> labels(3, 0);
  const segmentation::Graph graph;
  const Connectivity dot{3, {3}, {0, 1, 2}};
  const Image image =
      segment_picture({&dot, labels, &graph}, {{0, positions, {}}}, Camera::orbit(0, 0, false), 16);
  CHECK(image.width == 16);
  CHECK(image.height > 0);
}

}  // namespace reeb::tools
