#include "tools/segment_files.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>

#include "tools/json.h"
#include "tools/segment_picture.h"

namespace reeb::tools {
namespace {

// Little-endian bytes of a number of 4 bytes.
void append(std::string& out, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 255);
}

Json nodes_json(const segmentation::Graph& graph) {
  static constexpr const char* kTypes[] = {"minimum", "maximum", "saddle"};
  Json nodes = Json::array();
  for (const auto& node : graph.nodes) {
    nodes.push_back({{"vertex", node.vertex},
                     {"value", node.value},
                     {"type", kTypes[static_cast<size_t>(node.type)]},
                     {"component", node.component}});
    if (node.region != segmentation::kNoRegion) nodes.back()["region"] = node.region;
  }
  return nodes;
}

Json regions_json(const segmentation::Result& segmentation) {
  std::vector<uint32_t> vertices(segmentation.region_count, 0);
  for (const uint32_t label : segmentation.labels) ++vertices[label];
  Json regions = Json::array();
  for (uint32_t r = 0; r < segmentation.region_count; ++r) {
    regions.push_back({{"vertices", vertices[r]}, {"area", segmentation.region_areas[r]}});
  }
  return regions;
}

}  // namespace

std::string coloured_ply(const Connectivity& connectivity, std::span<const float> positions,
                         std::span<const uint32_t> labels) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(labels.size()) +
                    "\nproperty float x\nproperty float y\nproperty float z\n"
                    "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                    "property uint region\nelement face " +
                    std::to_string(connectivity.face_sizes.size()) +
                    "\nproperty list uint uint vertex_indices\nend_header\n";
  for (size_t v = 0; v < labels.size(); ++v) {
    for (size_t i = 0; i < 3; ++i) append(out, std::bit_cast<uint32_t>(positions[3 * v + i]));
    for (const double part : region_colour(labels[v])) {
      out += static_cast<char>(static_cast<unsigned char>(std::lround(255 * part)));
    }
    append(out, labels[v]);
  }
  const uint32_t* corner = connectivity.corners.data();
  for (const uint32_t size : connectivity.face_sizes) {
    append(out, size);
    for (uint32_t i = 0; i < size; ++i) append(out, *corner++);
  }
  return out;
}

std::string graph_obj(const segmentation::Graph& graph, const segmentation::SkeletonPose& pose) {
  std::ostringstream out;
  out.precision(9);
  const auto vertex = [&](const segmentation::Position& p) {
    out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  };
  for (const auto& node : pose.nodes) vertex(node);
  for (const auto& arc : pose.arcs) {
    for (const auto& point : arc) vertex(point);
  }
  size_t next = pose.nodes.size() + 1;
  for (size_t a = 0; a < pose.arcs.size(); ++a) {
    out << "o region_" << graph.arcs[a].region << "\nl " << graph.arcs[a].from + 1;
    for (size_t i = 0; i < pose.arcs[a].size(); ++i) out << ' ' << next++;
    out << ' ' << graph.arcs[a].to + 1 << '\n';
  }
  return out.str();
}

std::string graph_json(const segmentation::Result& segmentation,
                       const std::vector<segmentation::SkeletonPose>& poses) {
  Json arcs = Json::array(), frames = Json::array();
  for (const auto& arc : segmentation.graph.arcs) {
    arcs.push_back({{"from", arc.from}, {"to", arc.to}, {"region", arc.region}});
  }
  for (const auto& pose : poses) {
    frames.push_back({{"nodes", pose.nodes}, {"arcs", pose.arcs}, {"regions", pose.regions}});
  }
  const Json json{{"components", segmentation.graph.component_count},
                  {"loops", segmentation.graph.loops()},
                  {"extremities", segmentation.feature_points},
                  {"nodes", nodes_json(segmentation.graph)},
                  {"arcs", arcs},
                  {"regions", regions_json(segmentation)},
                  {"frames", frames}};
  return json.dump() + "\n";
}

}  // namespace reeb::tools
