#include "codec/common/collapse.h"

#include <algorithm>
#include <array>

namespace reeb {

namespace {

constexpr uint32_t kBaseSize = 64;   ///< stop at this many vertices
constexpr uint32_t kMaxValence = 9;  ///< of a removed vertex
constexpr uint32_t kMaxMerged = 12;  ///< valence that a collapse may give to its target
/// A vertex of more triangles is left out, triangles and all: with every valence bounded, so is the
/// time.
constexpr uint32_t kMaxFaces = 256;
constexpr uint32_t kMinProgress =
    200;  ///< stop when a level removes fewer than one vertex in this many

using Indices = std::vector<uint32_t>;

bool contains(const Indices& sorted, uint32_t x) {
  return std::binary_search(sorted.begin(), sorted.end(), x);
}

void insert_sorted(Indices& sorted, uint32_t x) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), x);
  if (at == sorted.end() || *at != x) sorted.insert(at, x);
}

void erase_sorted(Indices& sorted, uint32_t x) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), x);
  if (at != sorted.end() && *at == x) sorted.erase(at);
}

uint32_t count_common(const Indices& sorted, const Indices& few) {
  uint32_t n = 0;
  for (const uint32_t x : few) n += contains(sorted, x);
  return n;
}

class Collapser {
 public:
  Collapser(const GridPoints& points, std::span<const uint32_t> triangles, uint32_t max_extra)
      : points_(points),
        max_extra_(max_extra),
        neighbours_(points.size()),
        faces_(points.size()),
        seen_(points.size(), 0),
        locked_(points.size(), 0) {
    Indices face_count(points.size(), 0);
    for (const uint32_t v : triangles) ++face_count[v];
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
      const Triangle t = {triangles[i], triangles[i + 1], triangles[i + 2]};
      if (std::all_of(t.begin(), t.end(), [&](uint32_t v) { return face_count[v] <= kMaxFaces; }))
        add_triangle(t);
    }
    for (Indices& n : neighbours_) {
      std::sort(n.begin(), n.end());
      n.erase(std::unique(n.begin(), n.end()), n.end());
    }
  }

  CollapseSequence run() {
    CollapseSequence out;
    for (uint32_t v = 0; v < points_.size(); ++v)
      (neighbours_[v].empty() ? out.isolated : alive_).push_back(v);
    while (alive_.size() > kBaseSize) {
      const size_t removed = run_level(out.collapses);
      if (removed < std::max<size_t>(1, alive_.size() / kMinProgress)) break;
    }
    out.base = std::move(alive_);
    return out;
  }

 private:
  using Triangle = std::array<uint32_t, 3>;

  void add_triangle(const Triangle& t) {
    const auto id = static_cast<uint32_t>(triangles_.size());
    triangles_.push_back(t);
    for (int i = 0; i < 3; ++i) {
      faces_[t[i]].push_back(id);
      neighbours_[t[i]].push_back(t[(i + 1) % 3]);
      neighbours_[t[i]].push_back(t[(i + 2) % 3]);
    }
  }

  /// Vertices in the order in which this level tries them: short mean edges first.
  std::vector<uint64_t> candidates() const {
    std::vector<uint64_t> keys;
    keys.reserve(alive_.size());
    for (const uint32_t v : alive_) {
      uint64_t sum = 0;
      for (const uint32_t u : neighbours_[v]) sum += points_.distance_q4(v, u);
      const uint64_t mean = sum / std::max<size_t>(1, neighbours_[v].size());
      keys.push_back(mean << 32 | v);
    }
    std::sort(keys.begin(), keys.end());
    return keys;
  }

  size_t run_level(std::vector<Collapse>& out) {
    ++level_;
    const size_t before = out.size();
    for (const uint64_t key : candidates()) {
      const auto v = static_cast<uint32_t>(key);
      const size_t valence = neighbours_[v].size();
      if (locked_[v] == level_ || valence == 0 || valence > kMaxValence) continue;
      const int64_t target = choose_target(v);
      if (target < 0) continue;
      out.push_back({v, neighbours_[v], far_neighbours(v)});
      for (const uint32_t u : neighbours_[v]) locked_[u] = level_;
      collapse(v, static_cast<uint32_t>(target));
    }
    const size_t removed = out.size() - before;
    for (size_t i = before; i < out.size(); ++i)
      seen_[out[i].vertex] = UINT32_MAX;  // gone for good
    std::erase_if(alive_, [&](uint32_t v) { return seen_[v] == UINT32_MAX; });
    return removed;
  }

  uint32_t shared_faces(uint32_t v, uint32_t u) const {
    uint32_t n = 0;
    for (const uint32_t f : faces_[v]) {
      const Triangle& t = triangles_[f];
      n += t[0] == u || t[1] == u || t[2] == u;
    }
    return n;
  }

  /// Nearest neighbour that v can be merged into without changing the topology; -1 if there is
  /// none.
  int64_t choose_target(uint32_t v) const {
    const Indices& ring = neighbours_[v];
    const size_t face_count = faces_[v].size();
    const uint32_t wanted = face_count == 0 ? 0 : face_count == ring.size() ? 2 : 1;
    int64_t best = -1;
    uint64_t best_distance = 0;
    for (const uint32_t u : ring) {
      if (ring.size() > 2) {  // fewer neighbours: a loose end, nothing to protect
        const uint32_t shared = shared_faces(v, u);
        if (shared != wanted || count_common(neighbours_[u], ring) != shared) continue;
      }
      if (neighbours_[u].size() + ring.size() > kMaxMerged + 4) continue;
      const uint64_t d = points_.distance2(v, u);
      if (best < 0 || d < best_distance) {
        best = u;
        best_distance = d;
      }
    }
    return best;
  }

  /// Appends the unseen neighbours of `from`, nearest to v first.
  void append_next_ring(uint32_t v, const Indices& from, Indices& out) {
    std::vector<uint64_t> keys;
    for (const uint32_t w : from) {
      for (const uint32_t u : neighbours_[w]) {
        if (seen_[u] == stamp_) continue;
        seen_[u] = stamp_;
        keys.push_back(points_.distance2(v, u) << 25 | u);
      }
    }
    std::sort(keys.begin(), keys.end());
    for (const uint64_t key : keys) out.push_back(static_cast<uint32_t>(key & ((1u << 25) - 1)));
  }

  Indices far_neighbours(uint32_t v) {
    ++stamp_;
    seen_[v] = stamp_;
    for (const uint32_t u : neighbours_[v]) seen_[u] = stamp_;
    Indices second;
    append_next_ring(v, neighbours_[v], second);
    if (second.size() < max_extra_) {
      const Indices from = second;
      append_next_ring(v, from, second);
    }
    if (second.size() > max_extra_) second.resize(max_extra_);
    return second;
  }

  void collapse(uint32_t v, uint32_t target) {
    for (const uint32_t f : faces_[v]) {
      Triangle& t = triangles_[f];
      if (t[0] == target || t[1] == target || t[2] == target) {
        for (const uint32_t w : t) {
          if (w != v) std::erase(faces_[w], f);
        }
      } else {
        std::replace(t.begin(), t.end(), v, target);
        faces_[target].push_back(f);
      }
    }
    faces_[v].clear();
    for (const uint32_t w : neighbours_[v]) {
      erase_sorted(neighbours_[w], v);
      if (w == target) continue;
      insert_sorted(neighbours_[w], target);
      insert_sorted(neighbours_[target], w);
    }
    neighbours_[v].clear();
  }

  const GridPoints& points_;
  uint32_t max_extra_;
  std::vector<Indices> neighbours_;  ///< sorted
  std::vector<Indices> faces_;
  std::vector<Triangle> triangles_;
  Indices alive_;
  Indices seen_;    ///< stamp of the last search that met the vertex
  Indices locked_;  ///< level at which the vertex must stay
  uint32_t stamp_ = 0;
  uint32_t level_ = 0;
};

}  // namespace

CollapseSequence collapse_mesh(const GridPoints& points, std::span<const uint32_t> triangles,
                               uint32_t max_extra) {
  return Collapser(points, triangles, max_extra).run();
}

}  // namespace reeb
