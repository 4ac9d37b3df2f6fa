#include "segmentation/region_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "segmentation/regions.h"

namespace reeb::segmentation {
namespace {

constexpr int kContours = 24;  // looked at within the window
constexpr double kMaxExponent =
    2;  // bounds the pull of a crease whose radius is far below the contour's
constexpr double kMaxArcPart = 0.5;  // of an arc that a border may give away

// What is summed along an iso-contour.
struct ContourSums {
  double length = 0, curvature = 0;

  double concavity() const {
    if (length == 0) return std::numeric_limits<double>::infinity();
    const double radius = length / (2 * std::numbers::pi);
    const double exponent = std::clamp(curvature / length * radius, -kMaxExponent, kMaxExponent);
    return length * std::exp(exponent);
  }
};

class Cutter {
 public:
  Cutter(const Surface& surface, std::span<const double> f, const SimplifiedGraph& graph,
         const Eigen::VectorXd& curvature, const RegionCutOptions& options)
      : surface_(surface), f_(f), graph_(graph), curvature_(curvature), options_(options) {}

  RegionCut run(const ReebGraph& sweep) {
    label_arcs(sweep);
    choose_bodies();
    for (uint32_t a = 0; a < arc_count(); ++a) {
      move_border(a, graph_.arcs[a].from, graph_.arcs[a].from_value, graph_.arcs[a].to_value);
      move_border(a, graph_.arcs[a].to, graph_.arcs[a].to_value, graph_.arcs[a].from_value);
    }
    drop_small_bodies();
    return number_bodies();
  }

 private:
  uint32_t arc_count() const { return static_cast<uint32_t>(graph_.arcs.size()); }
  uint32_t node_count() const { return static_cast<uint32_t>(graph_.nodes.size()); }
  uint32_t node_label(uint32_t node) const { return arc_count() + node; }

  void label_arcs(const ReebGraph& sweep) {
    labels_.resize(surface_.vertex_count());
    for (uint32_t v = 0; v < labels_.size(); ++v) {
      const uint32_t swept = sweep.vertex_arc[v];
      labels_[v] =
          graph_.arc_of[swept] != kNone ? graph_.arc_of[swept] : node_label(graph_.node_of[swept]);
    }
  }

  bool goes_on(uint32_t arc) const {
    return degree_[graph_.arcs[arc].from] > 1 && degree_[graph_.arcs[arc].to] > 1;
  }

  // Body of each node: a label.
  void choose_bodies() {
    std::vector<uint32_t> size(arc_count() + node_count(), 0);
    for (const uint32_t label : labels_) ++size[label];
    for (uint32_t n = 0; n < node_count(); ++n) {
      degree_.push_back(graph_.degree(n));
      body_.push_back(node_label(n));
    }
    for (uint32_t a = 0; a < arc_count(); ++a) {
      if (!goes_on(a)) continue;
      for (const uint32_t node : {graph_.arcs[a].from, graph_.arcs[a].to}) {
        const bool first = body_[node] == node_label(node);
        if (first || size[a] > size[body_[node]]) body_[node] = a;
      }
    }
    for (uint32_t& label : labels_) {
      if (label >= arc_count()) label = body_[label - arc_count()];
    }
  }

  void move_border(uint32_t arc, uint32_t node, double near, double far) {
    if (degree_[node] < 3 || body_[node] == arc) return;
    // An arc over a ridge is not a function of f; its borders stay.
    const double span = std::abs(near - far);
    if (graph_.arcs[arc].length > 1.01 * span) return;
    const double window = std::min(options_.window, kMaxArcPart * span);
    const double direction = far < near ? -1 : 1;
    const double depth = best_depth(arc, near, direction, window);
    for (uint32_t v = 0; v < labels_.size(); ++v) {
      if (labels_[v] == arc && direction * (f_[v] - near) < depth) labels_[v] = body_[node];
    }
  }

  // How far from the value `near` into the arc the contour of least concavity function lies.
  double best_depth(uint32_t arc, double near, double direction, double window) const {
    if (window <= 0) return 0;
    std::array<ContourSums, kContours> contours;
    for (const Triple& t : surface_.triangles) {
      if (std::any_of(t.begin(), t.end(), [&](uint32_t v) { return labels_[v] != arc; })) continue;
      std::array<double, 3> depth;  // in contours
      for (int i = 0; i < 3; ++i) depth[i] = direction * (f_[t[i]] - near) / window * kContours;
      const auto [low, high] = std::minmax_element(depth.begin(), depth.end());
      const int first = std::max(0, static_cast<int>(std::floor(std::max(*low, -1.0))) + 1);
      for (int k = first; k < kContours && k < *high; ++k) add_segment(t, depth, k, contours[k]);
    }
    const auto least = std::min_element(
        contours.begin(), contours.end(),
        [](const ContourSums& a, const ContourSums& b) { return a.concavity() < b.concavity(); });
    return window * static_cast<double>(least - contours.begin()) / kContours;
  }

  void add_segment(const Triple& t, const std::array<double, 3>& depth, int contour,
                   ContourSums& sums) const {
    std::array<Point, 2> end;
    double curvature = 0;
    int found = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      if ((depth[i] < contour) == (depth[j] < contour) || found == 2) continue;
      const double share = (contour - depth[i]) / (depth[j] - depth[i]);
      end[found++] = (1 - share) * surface_.points[t[i]] + share * surface_.points[t[j]];
      curvature += 0.5 * ((1 - share) * curvature_[t[i]] + share * curvature_[t[j]]);
    }
    if (found < 2) return;
    const double length = (end[1] - end[0]).norm();
    sums.length += length;
    sums.curvature += length * curvature;
  }

  void drop_small_bodies() {
    std::vector<uint32_t> size(arc_count() + node_count(), 0);
    for (const uint32_t label : labels_) ++size[label];
    const double least = options_.min_body * static_cast<double>(labels_.size());
    for (uint32_t& label : labels_) {
      if (label >= arc_count() && size[label] < least) label = kNone;
    }
    grow_regions(surface_, labels_);
    keep_connected(surface_, labels_, arc_count() + node_count());
  }

  RegionCut number_bodies() {
    RegionCut cut;
    cut.region_count = arc_count();
    cut.node_region.assign(node_count(), kNone);
    for (uint32_t& label : labels_) {
      if (label < arc_count()) continue;
      uint32_t& region = cut.node_region[label - arc_count()];
      if (region == kNone) region = cut.region_count++;
      label = region;
    }
    cut.labels = std::move(labels_);
    return cut;
  }

  const Surface& surface_;
  std::span<const double> f_;
  const SimplifiedGraph& graph_;
  const Eigen::VectorXd& curvature_;
  RegionCutOptions options_;
  std::vector<uint32_t> labels_;  // arcs, then nodes
  std::vector<uint32_t> degree_, body_;
};

}  // namespace

RegionCut cut_regions(const Surface& surface, std::span<const double> f, const ReebGraph& sweep,
                      const SimplifiedGraph& graph, const Eigen::VectorXd& curvature,
                      const RegionCutOptions& options) {
  return Cutter(surface, f, graph, curvature, options).run(sweep);
}

}  // namespace reeb::segmentation
