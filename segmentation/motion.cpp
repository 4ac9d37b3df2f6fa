#include "segmentation/motion.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "segmentation/affine_fit.h"
#include "segmentation/own_unit.h"
#include "segmentation/patches.h"
#include "segmentation/regions.h"
#include "segmentation/surface.h"
#include "segmentation/union_find.h"

namespace reeb::segmentation {
namespace {

constexpr uint32_t kMaxPatches = 2000;
// Frames that merging looks at; motion is smooth in time.
constexpr uint32_t kMaxFrames = 64;

// Labels of the vertices of one piece.
std::vector<uint32_t> labels_of(const Pieces& pieces, uint32_t piece,
                                std::span<const uint32_t> labels) {
  std::vector<uint32_t> local;
  for (const uint32_t v : pieces.original[piece]) local.push_back(labels[v]);
  return local;
}

std::vector<uint32_t> patches_of(const MotionInput& input, const Pieces& pieces,
                                 std::span<const uint32_t> labels, uint32_t patch_vertices) {
  uint32_t count = 0;
  std::vector<std::vector<uint32_t>> local;
  for (uint32_t p = 0; p < pieces.surfaces.size(); ++p) {
    local.push_back(
        cut_patches(pieces.surfaces[p], labels_of(pieces, p, labels), patch_vertices, count));
  }
  std::vector<uint32_t> patches(labels.size(), kNone);
  for (uint32_t v = 0; v < labels.size(); ++v) {
    if (pieces.piece[v] != kNone) patches[v] = local[pieces.piece[v]][pieces.local[v]];
  }
  if (count == 0) return std::vector<uint32_t>(labels.size(), 0);
  // Thousands of tiny pieces: the segmentation has grouped them already.
  if (count > 2 * kMaxPatches) return {labels.begin(), labels.end()};
  std::vector<double> unused(labels.size());
  label_by_nearest(input.positions, patches, unused);
  return patches;
}

std::vector<RegionLink> all_links(const MotionInput& input, const Pieces& pieces,
                                  const std::vector<uint32_t>& labels) {
  std::vector<RegionLink> links;
  for (uint32_t p = 0; p < pieces.surfaces.size(); ++p) {
    const auto borders = border_links(pieces.surfaces[p], labels_of(pieces, p, labels));
    links.insert(links.end(), borders.begin(), borders.end());
  }
  const auto gaps = gap_links(input.positions, labels, links);
  links.insert(links.end(), gaps.begin(), gaps.end());
  return links;
}

// Merges regions, the cheapest pair of neighbours first.
class CheapestMerger {
 public:
  CheapestMerger(std::vector<AffineSums> sums, const std::vector<RegionLink>& links)
      : sums_(std::move(sums)), neighbours_(sums_.size()) {
    for (const AffineSums& region : sums_) {
      residual_.push_back(residual(region));
      error_ += residual_.back();
    }
    for (const RegionLink& link : links) connect(link.a, link.b);
  }

  double error() const { return error_; }

  /// Merges once; the pair is (kept, dissolved). There are at least two regions.
  std::pair<uint32_t, uint32_t> step() {
    const auto [cost, pair] = *queue_.begin();
    const auto [into, from] = pair;
    const std::set<uint32_t> around = neighbours_[from];
    disconnect_all(from);
    const std::set<uint32_t> kept = neighbours_[into];
    disconnect_all(into);
    sums_[into].add(sums_[from]);
    const double merged = residual(sums_[into]);
    error_ += merged - residual_[into] - residual_[from];
    residual_[into] = merged;
    for (const uint32_t other : around) {
      if (other != into) connect(into, other);
    }
    for (const uint32_t other : kept) {
      if (other != from) connect(into, other);
    }
    return pair;
  }

 private:
  using Pair = std::pair<uint32_t, uint32_t>;

  void connect(uint32_t a, uint32_t b) {
    if (!neighbours_[a].insert(b).second) return;
    neighbours_[b].insert(a);
    AffineSums both = sums_[a];
    both.add(sums_[b]);
    const Pair pair = std::minmax(a, b);
    const double cost = residual(both) - residual_[a] - residual_[b];
    cost_[pair] = cost;
    queue_.insert({cost, pair});
  }

  void disconnect_all(uint32_t a) {
    for (const uint32_t b : neighbours_[a]) {
      const auto at = cost_.find(std::minmax(a, b));
      queue_.erase({at->second, at->first});
      cost_.erase(at);
      neighbours_[b].erase(a);
    }
    neighbours_[a].clear();
  }

  std::vector<AffineSums> sums_;
  std::vector<double> residual_;
  double error_ = 0;
  std::vector<std::set<uint32_t>> neighbours_;
  std::map<Pair, double> cost_;
  std::set<std::pair<double, Pair>> queue_;
};

class BorderAdjuster {
 public:
  BorderAdjuster(const MotionInput& input, std::vector<uint32_t>& labels)
      : labels_(labels),
        pieces_(split_pieces(input.positions, input.triangles, true)),
        space_(motion_space(input, kMaxFrames)),
        region_count_(*std::max_element(labels.begin(), labels.end()) + 1),
        size_(region_count_, 0) {
    std::vector<uint32_t> lowest(labels.size(), kNone);
    for (uint32_t v = 0; v < labels.size(); ++v) {
      if (pieces_.piece[v] != kNone)
        lowest[v] = pieces_.original[pieces_.piece[v]][pieces_.local[v]];
    }
    doubles_ = group_by(lowest, static_cast<uint32_t>(labels.size()));
    for (uint32_t v = 0; v < labels.size(); ++v) {
      if (lowest[v] != kNone) labels_[v] = labels_[lowest[v]];
      ++size_[labels_[v]];
    }
  }

  /// One alternation; returns the number of vertices that moved.
  uint32_t sweep() {
    maps_.clear();
    for (const AffineSums& sums : region_sums(space_, labels_, region_count_)) {
      maps_.push_back(affine_fit(sums));
    }
    uint32_t moved = 0;
    for (uint32_t p = 0; p < pieces_.surfaces.size(); ++p) {
      for (uint32_t v = 0; v < pieces_.surfaces[p].vertex_count(); ++v) moved += reconsider(p, v);
    }
    return moved;
  }

 private:
  uint32_t label(uint32_t piece, uint32_t local) const {
    return labels_[pieces_.original[piece][local]];
  }

  double error(uint32_t vertex, uint32_t region) const {
    double sum = 0;
    for (const uint32_t v : doubles_[vertex]) sum += squared_error(space_, v, maps_[region]);
    return sum;
  }

  bool reconsider(uint32_t piece, uint32_t v) {
    const Surface& surface = pieces_.surfaces[piece];
    const uint32_t vertex = pieces_.original[piece][v];
    const uint32_t own = labels_[vertex];
    candidates_.clear();
    for (const uint32_t e : surface.vertex_edges[v]) {
      const uint32_t other = label(piece, surface.opposite(e, v));
      if (other != own) candidates_.insert(other);
    }
    if (candidates_.empty()) return false;
    uint32_t best = own;
    double least = error(vertex, own);
    for (const uint32_t region : candidates_) {
      const double e = error(vertex, region);
      if (e >= least) continue;
      least = e;
      best = region;
    }
    if (best == own || !may_leave(piece, v)) return false;
    for (const uint32_t w : doubles_[vertex]) {
      labels_[w] = best;
      --size_[own];
      ++size_[best];
    }
    return true;
  }

  // Around a vertex that leaves, the rest of its region hangs together.
  bool may_leave(uint32_t piece, uint32_t v) {
    const Surface& surface = pieces_.surfaces[piece];
    const uint32_t own = label(piece, v);
    if (size_[own] <= doubles_[pieces_.original[piece][v]].size()) return false;
    std::map<uint32_t, uint32_t> group;
    for (const uint32_t e : surface.vertex_edges[v]) {
      const uint32_t w = surface.opposite(e, v);
      if (label(piece, w) == own) group.emplace(w, w);
    }
    size_t groups = group.size();
    for (const uint32_t t : surface.vertex_triangles[v]) {
      std::vector<uint32_t> ends;
      for (const uint32_t w : surface.triangles[t]) {
        if (group.count(w) > 0) ends.push_back(group[w]);
      }
      if (ends.size() < 2 || ends[0] == ends[1]) continue;
      --groups;
      for (auto& [w, g] : group) g = g == ends[1] ? ends[0] : g;
    }
    return groups <= 1;
  }

  std::vector<uint32_t>& labels_;
  Pieces pieces_;
  MotionSpace space_;
  uint32_t region_count_;
  std::vector<size_t> size_;
  Rows doubles_;  // vertices of the same position, in the row of the lowest
  std::vector<AffineMap> maps_;
  std::set<uint32_t> candidates_;
};

}  // namespace

MotionPartitions::MotionPartitions(const MotionInput& whole_input, const Result& segmentation,
                                   uint32_t patch_vertices) {
  if (segmentation.labels.empty()) return;
  const uint32_t vertices = static_cast<uint32_t>(segmentation.labels.size());
  const uint32_t per_patch = std::max({patch_vertices, 5u, vertices / kMaxPatches});
  const OwnUnit own = in_own_unit(whole_input.positions);
  const MotionInput input{own.positions, whole_input.triangles, whole_input.frames};
  const Pieces pieces = split_pieces(input.positions, input.triangles, true);
  patches_ = patches_of(input, pieces, segmentation.labels, per_patch);
  finest_ = renumber(patches_);
  const MotionSpace space = motion_space(input, kMaxFrames);
  CheapestMerger merger(region_sums(space, patches_, finest_), all_links(input, pieces, patches_));
  squared_error_.assign(finest_, space.scale * merger.error());
  for (uint32_t count = finest_ - 1; count > 0; --count) {
    const auto [into, from] = merger.step();
    merges_.push_back({into, from});
    squared_error_[count - 1] = space.scale * merger.error();
  }
}

std::vector<uint32_t> MotionPartitions::labels(uint32_t count) const {
  UnionFind sets(finest_);
  for (uint32_t i = 0; i + count < finest_; ++i) sets.unite(merges_[i].into, merges_[i].from);
  std::vector<uint32_t> labels = patches_;
  for (uint32_t& label : labels) label = sets.find(label);
  renumber(labels);
  return labels;
}

std::vector<uint32_t> adjust_borders(const MotionInput& input, std::vector<uint32_t> labels,
                                     uint32_t sweeps) {
  if (labels.empty() || input.frames.empty()) return labels;
  BorderAdjuster adjuster(input, labels);
  for (uint32_t i = 0; i < sweeps; ++i) {
    if (adjuster.sweep() == 0) break;
  }
  return labels;
}

}  // namespace reeb::segmentation
