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

TEST_CASE("a picture is rendered, or the message names the missing program") {
  const Creature c;
  const PictureSubject subject{c.shot.connectivity.corners, c.result.labels, &c.result.graph};
  std::vector<PictureFrame> frames;
  for (uint32_t t = 0; t < 2; ++t) {
    frames.push_back({c.shot.frame(t), c.skeleton.place(c.shot.frame(t))});
  }
  const PovrayScene scene = povray_scene(subject, frames, Camera::orbit(35, 12, false), 32);
  CHECK(scene.width == 64);
  CHECK(lines_starting(scene.text, "mesh2 {") == 2);
  std::string png;
  const Status status = render_povray(scene, 1, png);
  if (status.ok()) {
    CHECK(png.starts_with("\x89PNG"));
  } else {
    CHECK_THAT(status.message(), Catch::Contains("povray"));
  }
}

}  // namespace reeb::tools
