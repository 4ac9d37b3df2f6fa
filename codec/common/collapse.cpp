#include "codec/common/collapse.h"

#include <algorithm>
#include <array>

#include "codec/common/list_pool.h"

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

class Collapser {
 public:
  Collapser(const GridPoints& points, std::span<const uint32_t> triangles, uint32_t max_extra)
      : points_(points),
        max_extra_(max_extra),
        neighbours_({}),
        faces_({}),
        seen_(points.size(), 0),
        near_(points.size(), 0),
        shared_(points.size(), 0),
        locked_(points.size(), 0) {
    Indices face_count(points.size(), 0);
    for (const uint32_t v : triangles) ++face_count[v];
    const auto crowded = [&](uint32_t v) { return face_count[v] > kMaxFaces; };
    Indices kept;
    kept.reserve(triangles.size());
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
      const auto corners = triangles.subspan(i, 3);
      if (std::none_of(corners.begin(), corners.end(), crowded))
        kept.insert(kept.end(), corners.begin(), corners.end());
    }
    make_lists(kept);
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

  void make_lists(const Indices& corners) {
    Indices count(points_.size(), 0);
    for (const uint32_t v : corners) ++count[v];
    Indices room(points_.size());
    for (size_t v = 0; v < room.size(); ++v) room[v] = count[v] + kMaxMerged / 2;
    faces_ = ListPool(room);
    for (size_t v = 0; v < room.size(); ++v) room[v] = std::max(2 * count[v], kMaxMerged + 4);
    neighbours_ = ListPool(room);
    triangles_.reserve(corners.size() / 3);
    for (size_t i = 0; i < corners.size(); i += 3)
      add_triangle({corners[i], corners[i + 1], corners[i + 2]});
    for (uint32_t v = 0; v < points_.size(); ++v) neighbours_.sort_unique(v);
  }

  void add_triangle(const Triangle& t) {
    const auto id = static_cast<uint32_t>(triangles_.size());
    triangles_.push_back(t);
    for (uint32_t i = 0; i < 3; ++i) {
      faces_.push_back(t[i], id);
      neighbours_.push_back(t[i], t[(i + 1) % 3]);
      neighbours_.push_back(t[i], t[(i + 2) % 3]);
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
      Collapse& made = out.emplace_back();
      made.vertex = v;
      for (const uint32_t u : neighbours_[v]) {
        made.ring.push_back(u);
        locked_[u] = level_;
      }
      find_far_neighbours(v);
      for (const uint32_t u : far_) made.extra.push_back(u);
      collapse(v, static_cast<uint32_t>(target));
    }
    const size_t removed = out.size() - before;
    for (size_t i = before; i < out.size(); ++i)
      seen_[out[i].vertex] = UINT32_MAX;  // gone for good
    std::erase_if(alive_, [&](uint32_t v) { return seen_[v] == UINT32_MAX; });
    return removed;
  }

  /// Leaves in shared_ how many triangles of v each of its neighbours is in, and in near_ the
  /// stamp of v for all of them.
  void mark_neighbours(uint32_t v) {
    ++near_stamp_;
    for (const uint32_t u : neighbours_[v]) {
      near_[u] = near_stamp_;
      shared_[u] = 0;
    }
    for (const uint32_t f : faces_[v]) {
      for (const uint32_t w : triangles_[f]) ++shared_[w];
    }
  }

  /// Nearest neighbour that v can be merged into without changing the topology; -1 if there is
  /// none.
  int64_t choose_target(uint32_t v) {
    const std::span<const uint32_t> ring = neighbours_[v];
    mark_neighbours(v);
    const size_t face_count = faces_[v].size();
    const uint32_t wanted = face_count == 0 ? 0 : face_count == ring.size() ? 2 : 1;
    int64_t best = -1;
    uint64_t best_distance = 0;
    for (const uint32_t u : ring) {
      if (ring.size() > 2) {  // fewer neighbours: a loose end, nothing to protect
        const std::span<const uint32_t> others = neighbours_[u];
        const auto common = std::count_if(others.begin(), others.end(),
                                          [&](uint32_t w) { return near_[w] == near_stamp_; });
        if (shared_[u] != wanted || static_cast<uint32_t>(common) != wanted) continue;
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

  /// Appends the unseen neighbours of `from` to far_, nearest to v first.
  void append_next_ring(uint32_t v, std::span<const uint32_t> from) {
    keys_.clear();
    for (const uint32_t w : from) {
      for (const uint32_t u : neighbours_[w]) {
        if (seen_[u] == stamp_) continue;
        seen_[u] = stamp_;
        keys_.push_back(points_.distance2(v, u) << 25 | u);
      }
    }
    std::sort(keys_.begin(), keys_.end());
    for (const uint64_t key : keys_) far_.push_back(static_cast<uint32_t>(key & ((1u << 25) - 1)));
  }

  void find_far_neighbours(uint32_t v) {
    ++stamp_;
    seen_[v] = stamp_;
    for (const uint32_t u : neighbours_[v]) seen_[u] = stamp_;
    far_.clear();
    append_next_ring(v, neighbours_[v]);
    if (far_.size() < max_extra_) append_next_ring(v, Indices(far_));
    if (far_.size() > max_extra_) far_.resize(max_extra_);
  }

  void collapse(uint32_t v, uint32_t target) {
    // Of copies: the lists may move when others grow.
    const std::span<const uint32_t> faces = faces_[v];
    scratch_.assign(faces.begin(), faces.end());
    for (const uint32_t f : scratch_) {
      Triangle& t = triangles_[f];
      if (t[0] == target || t[1] == target || t[2] == target) {
        for (const uint32_t w : t) {
          if (w != v) faces_.erase(w, f);
        }
      } else {
        std::replace(t.begin(), t.end(), v, target);
        faces_.push_back(target, f);
      }
    }
    faces_.clear(v);
    const std::span<const uint32_t> neighbours = neighbours_[v];
    scratch_.assign(neighbours.begin(), neighbours.end());
    for (const uint32_t w : scratch_) {
      neighbours_.erase(w, v);
      if (w == target) continue;
      neighbours_.insert_sorted(w, target);
      neighbours_.insert_sorted(target, w);
    }
    neighbours_.clear(v);
  }

  const GridPoints& points_;
  uint32_t max_extra_;
  ListPool neighbours_;  ///< sorted
  ListPool faces_;
  std::vector<Triangle> triangles_;
  Indices alive_;
  Indices seen_;    ///< stamp of the last search that met the vertex
  Indices near_;    ///< near_stamp_ for the neighbours of the vertex last marked
  Indices shared_;  ///< its triangles that they are in
  Indices locked_;  ///< level at which the vertex must stay
  Indices far_;     ///< what find_far_neighbours found
  Indices scratch_;
  std::vector<uint64_t> keys_;
  uint32_t near_stamp_ = 0;
  uint32_t stamp_ = 0;
  uint32_t level_ = 0;
};

}  // namespace

CollapseSequence collapse_mesh(const GridPoints& points, std::span<const uint32_t> triangles,
                               uint32_t max_extra) {
  return Collapser(points, triangles, max_extra).run();
}

}  // namespace reeb
