#include <algorithm>
#include <map>

#include "segmentation/regions.h"
#include "segmentation/segmentation.h"
#include "segmentation/union_find.h"

namespace reeb::segmentation {
namespace {

class Merger {
 public:
  explicit Merger(const Result& result)
      : areas_(result.region_areas),
        merged_(result.region_count),
        neighbours_(result.region_count) {
    for (const RegionLink& link : result.links) {
      // A border always comes before a gap, and a narrow gap before a wide one.
      const double strength = link.border > 0 ? link.border : -link.gap;
      neighbours_[link.a][link.b] = neighbours_[link.b][link.a] = strength;
    }
  }

  /// Merges the smallest region with the neighbour of the strongest link.
  bool step() {
    const uint32_t region = smallest();
    if (region == kNone) return false;
    const auto& around = neighbours_[region];
    const uint32_t target =
        std::max_element(around.begin(), around.end(), [](const auto& x, const auto& y) {
          return x.second < y.second;
        })->first;
    merge(region, target);
    return true;
  }

  uint32_t find(uint32_t region) { return merged_.find(region); }

 private:
  uint32_t smallest() {
    uint32_t best = kNone;
    for (uint32_t r = 0; r < areas_.size(); ++r) {
      if (merged_.find(r) != r || neighbours_[r].empty()) continue;
      if (best == kNone || areas_[r] < areas_[best]) best = r;
    }
    return best;
  }

  void merge(uint32_t region, uint32_t target) {
    merged_.unite(target, region);
    areas_[target] += areas_[region];
    neighbours_[target].erase(region);
    for (const auto& [other, strength] : neighbours_[region]) {
      neighbours_[other].erase(region);
      if (other == target) continue;
      const auto [at, fresh] = neighbours_[target].try_emplace(other, strength);
      double& sum = at->second;
      if (!fresh) sum = sum > 0 && strength > 0 ? sum + strength : std::max(sum, strength);
      neighbours_[other][target] = sum;
    }
    neighbours_[region].clear();
  }

  std::vector<double> areas_;
  UnionFind merged_;  // a living region represents those merged into it
  std::vector<std::map<uint32_t, double>> neighbours_;
};

}  // namespace

std::vector<uint32_t> merge_regions(const Result& result, uint32_t target_count) {
  Merger merger(result);
  for (uint32_t count = result.region_count; count > std::max(target_count, 1u); --count) {
    if (!merger.step()) break;
  }
  std::vector<uint32_t> labels = result.labels;
  for (uint32_t& label : labels) label = merger.find(label);
  renumber(labels);
  return labels;
}

}  // namespace reeb::segmentation
