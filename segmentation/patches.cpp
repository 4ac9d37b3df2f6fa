#include "segmentation/patches.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace reeb::segmentation {
namespace {

class PatchCutter {
 public:
  PatchCutter(const Surface& surface, const std::vector<uint32_t>& labels)
      : surface_(surface),
        labels_(labels),
        patch_(labels.size(), kNone),
        distance_(labels.size(), std::numeric_limits<double>::infinity()) {}

  /// Adds seeds to one region until it has `count` patches and none of its vertices, `members`, is
  /// left.
  void cut(std::span<const uint32_t> members, uint32_t count, uint32_t& next) {
    plant(members.front(), next++);
    for (uint32_t patches = 1;; ++patches) {
      const uint32_t far =
          *std::max_element(members.begin(), members.end(),
                            [&](uint32_t a, uint32_t b) { return distance_[a] < distance_[b]; });
      const bool enough = patches >= count && std::isfinite(distance_[far]);
      if (enough || distance_[far] == 0) return;
      plant(far, next++);
    }
  }

  std::vector<uint32_t> take() { return std::move(patch_); }

 private:
  // Spreads a new patch over the vertices of the region that are nearer to it than to their own
  // seed.
  void plant(uint32_t seed, uint32_t patch) {
    using Item = std::pair<double, uint32_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    distance_[seed] = 0;
    patch_[seed] = patch;
    queue.push({0.0, seed});
    while (!queue.empty()) {
      const auto [d, v] = queue.top();
      queue.pop();
      if (d > distance_[v] || patch_[v] != patch) continue;
      for (const uint32_t e : surface_.vertex_edges[v]) {
        const uint32_t w = surface_.opposite(e, v);
        const double through = d + surface_.edge_length(e);
        if (labels_[w] != labels_[seed] || through >= distance_[w]) continue;
        distance_[w] = through;
        patch_[w] = patch;
        queue.push({through, w});
      }
    }
  }

  const Surface& surface_;
  const std::vector<uint32_t>& labels_;
  std::vector<uint32_t> patch_;
  std::vector<double> distance_;
};

}  // namespace

std::vector<uint32_t> cut_patches(const Surface& surface, const std::vector<uint32_t>& labels,
                                  uint32_t patch_vertices, uint32_t& first) {
  const uint32_t regions = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
  const Rows members = group_by(labels, regions);
  PatchCutter cutter(surface, labels);
  for (uint32_t r = 0; r < regions; ++r) {
    const auto vertices = members[r];
    if (vertices.empty()) continue;
    const size_t count = (vertices.size() + patch_vertices / 2) / patch_vertices;
    cutter.cut(vertices, static_cast<uint32_t>(std::max<size_t>(count, 1)), first);
  }
  return cutter.take();
}

}  // namespace reeb::segmentation
