#include "segmentation/skeleton.h"

#include <algorithm>

namespace reeb::segmentation {
namespace {

using Vector = std::array<float, 3>;

// A running mean of points.
class Mean {
 public:
  void add(std::span<const float> frame, uint32_t v) {
    for (size_t i = 0; i < 3; ++i) sum_[i] += frame[3 * static_cast<size_t>(v) + i];
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  Vector value() const {
    Vector mean = {};
    for (size_t i = 0; i < 3; ++i) mean[i] = static_cast<float>(sum_[i] / count_);
    return mean;
  }

 private:
  std::array<double, 3> sum_ = {};
  double count_ = 0;
};

// For each node, the regions that meet there.
std::vector<std::vector<uint32_t>> regions_at_nodes(const Graph& graph) {
  std::vector<std::vector<uint32_t>> regions(graph.nodes.size());
  for (const Arc& arc : graph.arcs) {
    regions[arc.from].push_back(arc.region);
    if (arc.to != arc.from) regions[arc.to].push_back(arc.region);
  }
  return regions;
}

// Means of the triangles that hold two or more of the regions of a node.
std::vector<Mean> border_means(const Result& segmentation, std::span<const uint32_t> triangles,
                               std::span<const float> frame) {
  const auto regions = regions_at_nodes(segmentation.graph);
  std::vector<std::vector<uint32_t>> nodes_of(segmentation.region_count);
  for (uint32_t n = 0; n < regions.size(); ++n) {
    for (const uint32_t region : regions[n]) nodes_of[region].push_back(n);
  }
  const std::vector<uint32_t>& labels = segmentation.labels;
  std::vector<Mean> means(regions.size());
  for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const auto corners = triangles.subspan(t, 3);
    if (*std::max_element(corners.begin(), corners.end()) >= labels.size()) continue;
    const uint32_t a = labels[corners[0]], b = labels[corners[1]], c = labels[corners[2]];
    if (a == b && b == c) continue;
    const uint32_t other = b != a ? b : c;
    for (const uint32_t n : nodes_of[a]) {
      const auto& around = regions[n];
      if (std::find(around.begin(), around.end(), other) == around.end()) continue;
      for (const uint32_t v : corners) means[n].add(frame, v);
    }
  }
  return means;
}

}  // namespace

Skeleton place_skeleton(const Result& segmentation, std::span<const uint32_t> triangles,
                        std::span<const float> frame) {
  const Graph& graph = segmentation.graph;
  std::vector<Mean> centroids(segmentation.region_count);
  for (uint32_t v = 0; v < segmentation.labels.size(); ++v) {
    centroids[segmentation.labels[v]].add(frame, v);
  }
  const std::vector<Mean> borders = border_means(segmentation, triangles, frame);
  Skeleton skeleton;
  for (uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const Node& node = graph.nodes[n];
    Mean place;
    place.add(frame, node.vertex);
    if (node.region != kNoRegion) {
      place = centroids[node.region];
    } else if (node.type == NodeType::kSaddle && !borders[n].empty()) {
      place = borders[n];
    }
    skeleton.nodes.push_back(place.value());
  }
  for (const Arc& arc : graph.arcs) skeleton.arcs.push_back(centroids[arc.region].value());
  return skeleton;
}

}  // namespace reeb::segmentation
