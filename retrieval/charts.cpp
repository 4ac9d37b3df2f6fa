#include "retrieval/charts.h"

#include <algorithm>
#include <numbers>

namespace reeb::retrieval {
namespace {

// Triangles by region: that of two of the corners, or else the least.
std::vector<uint32_t> triangle_regions(const Surface& surface, std::span<const uint32_t> labels) {
  std::vector<uint32_t> regions;
  for (const auto& [a, b, c] : surface.triangles) {
    const uint32_t la = labels[a], lb = labels[b], lc = labels[c];
    regions.push_back(la == lb || la == lc ? la : lb == lc ? lb : std::min({la, lb, lc}));
  }
  return regions;
}

// How many boundaries are no small holes; the longest one never is.
size_t true_boundaries(const Patch& patch, double hole_area) {
  size_t count = std::min<size_t>(1, patch.boundaries.size());
  for (; count < patch.boundaries.size(); ++count) {
    const double length = loop_length(patch.surface, patch.boundaries[count]);
    if (length * length < 4 * std::numbers::pi * hole_area * patch.area) break;
  }
  return count;
}

class ChartCutter {
 public:
  explicit ChartCutter(const ChartOptions& options) : options_(options) {}

  Charts run(const Surface& surface, std::span<const uint32_t> labels) {
    least_ = options_.least_area * total_area(surface);
    const std::vector<uint32_t> regions = triangle_regions(surface, labels);
    const uint32_t count =
        regions.empty() ? 0 : *std::max_element(regions.begin(), regions.end()) + 1;
    const segmentation::Rows rows = segmentation::group_by(regions, count);
    for (uint32_t r = 0; r < count; ++r) add(glue(surface, rows[r]));
    find_neighbours(surface);
    return std::move(charts_);
  }

 private:
  void add(std::vector<Patch>&& parts) {
    for (Patch& part : parts) {
      if (!(part.area > 0) || part.area < least_) continue;
      if (part.boundaries.empty()) {
        add(halve(part));
        continue;
      }
      Patch chart = cap_boundaries(part, true_boundaries(part, options_.hole_area));
      if (chart.handles() > 0) chart = cut_to_disc(chart);
      charts_.patches.push_back(cap_boundaries(chart, 2));
    }
  }

  void find_neighbours(const Surface& surface) {
    const size_t count = charts_.patches.size();
    std::vector<uint32_t> chart_of(surface.triangles.size(), kNone);
    for (uint32_t c = 0; c < count; ++c) {
      for (const uint32_t t : charts_.patches[c].original) {
        if (t != kNone) chart_of[t] = c;
      }
    }
    charts_.neighbours.resize(count);
    for (uint32_t e = 0; e < surface.edges.size(); ++e) {
      for (const uint32_t s : surface.edge_triangles[e]) {
        for (const uint32_t t : surface.edge_triangles[e]) {
          const uint32_t a = chart_of[s], b = chart_of[t];
          if (a != b && a != kNone && b != kNone) charts_.neighbours[a].push_back(b);
        }
      }
    }
    for (std::vector<uint32_t>& list : charts_.neighbours) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  }

  ChartOptions options_;
  double least_ = 0;
  Charts charts_;
};

}  // namespace

Charts cut_charts(const Surface& surface, std::span<const uint32_t> labels,
                  const ChartOptions& options) {
  return ChartCutter(options).run(surface, labels);
}

}  // namespace reeb::retrieval
