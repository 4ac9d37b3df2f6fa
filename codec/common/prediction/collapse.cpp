#include "codec/common/prediction/collapse.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "codec/common/base/sort_few.h"
#include "codec/common/prediction/neighbour_lists.h"

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

constexpr size_t kMaxFrom = 16;  ///< vertices whose neighbours are looked for together
constexpr uint32_t kNoFace = UINT32_MAX;

using Indices = std::vector<uint32_t>;

class Collapser {
 public:
  Collapser(const GridPoints& points, std::span<const uint32_t> triangles, uint32_t max_extra)
      : points_(points),
        max_extra_(max_extra),
        none_(points.size()),
        neighbours_({}, none_),
        faces_({}, kNoFace),
        edges_(points.size(), 0),
        seen_(points.size() + 1, 0),
        locked_(points.size() + 1, 0) {
    Indices face_count(points.size(), 0);
    for (const uint32_t v : triangles) ++face_count[v];
    const auto crowded = [&](uint32_t v) { return face_count[v] > kMaxFaces; };
    triangles_.reserve(triangles.size() / 3);
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
      const Triangle t = {triangles[i], triangles[i + 1], triangles[i + 2]};
      if (std::none_of(t.begin(), t.end(), crowded)) triangles_.push_back(t);
    }
    make_lists();
  }

  CollapseSequence run() {
    CollapseSequence out;
    for (uint32_t v = 0; v < points_.size(); ++v)
      (neighbours_[v].empty() ? out.isolated : alive_).push_back(v);
    out.collapses.reserve(alive_.size());
    while (alive_.size() > kBaseSize) {
      const size_t removed = run_level(out.collapses);
      if (removed < std::max<size_t>(1, alive_.size() / kMinProgress)) break;
    }
    out.base = std::move(alive_);
    return out;
  }

 private:
  using Triangle = std::array<uint32_t, 3>;

  /// Returns a function that tells of a vertex whether it is seen for the first time under this
  /// stamp.
  auto marker(uint32_t stamp) {
    return [this, stamp](uint32_t v) { return std::exchange(seen_[v], stamp) != stamp; };
  }

  /// `vertices` may be filled up with none_, which is not marked.
  void mark(std::span<const uint32_t> vertices) {
    ++stamp_;
    for (const uint32_t v : vertices) seen_[v] = stamp_;
    seen_[none_] = 0;
  }
  bool marked(uint32_t v) const { return seen_[v] == stamp_; }

  void make_lists() {
    Indices room(points_.size(), 0);  // three more triangles than there are at first
    for (const Triangle& t : triangles_) {
      for (const uint32_t v : t) ++room[v];
    }
    for (uint32_t& r : room) r += kMaxMerged / 2;
    faces_ = NeighbourLists(room, kNoFace);
    for (uint32_t& r : room) r = 2 * (r - kMaxMerged / 2);
    neighbours_ = NeighbourLists(room, none_);
    for (uint32_t f = 0; f < triangles_.size(); ++f) {
      const Triangle& t = triangles_[f];
      for (uint32_t i = 0; i < 3; ++i) {
        faces_.push_back(t[i], f);
        neighbours_.push_back(t[i], t[(i + 1) % 3]);
        neighbours_.push_back(t[i], t[(i + 2) % 3]);
      }
    }
    size_t longest = kMaxMerged + 4;
    for (uint32_t v = 0; v < points_.size(); ++v) {
      neighbours_.filter(v, marker(++stamp_));
      longest = std::max(longest, neighbours_.by_eights(v).size());
      for (const uint32_t u : neighbours_[v]) edges_[v] += points_.distance_q4(v, u);
    }
    far_.resize(by_eights(kMaxFrom * longest + 1));
  }

  /// Vertices in the order in which this level tries them: short mean edges first. By radix; those
  /// alive are in order of their indices.
  const std::vector<uint64_t>& candidates() {
    constexpr uint32_t kDigitBits = 11;  // two digits are enough for the longest edge
    constexpr uint32_t kDigits = 1u << kDigitBits;
    std::array<uint32_t, kDigits> low_begin{}, high_begin{};
    keys_.clear();
    for (const uint32_t v : alive_) {
      const uint64_t mean = edges_[v] / std::max<size_t>(1, neighbours_[v].size());
      keys_.push_back(mean << 32 | v);
      ++low_begin[mean % kDigits];
      ++high_begin[mean >> kDigitBits];
    }
    sort_by_digit(32, low_begin);
    sort_by_digit(32 + kDigitBits, high_begin);
    return keys_;
  }

  /// Sorts the keys, stably, by the digit from bit `shift` on, of which `begin` has the counts.
  template <size_t kDigits>
  void sort_by_digit(uint32_t shift, std::array<uint32_t, kDigits>& begin) {
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0u);
    sorted_.resize(keys_.size());
    for (const uint64_t key : keys_) sorted_[begin[(key >> shift) % kDigits]++] = key;
    keys_.swap(sorted_);
  }

  size_t run_level(std::vector<Collapse>& out) {
    ++level_;
    const size_t before = out.size();
    for (const uint64_t key : candidates()) {
      const auto v = static_cast<uint32_t>(key);
      const size_t valence = neighbours_[v].size();
      if (locked_[v] == level_ || valence == 0 || valence > kMaxValence) continue;
      take_near(v);
      const int64_t target = choose_target(v);
      if (target < 0) continue;
      Collapse& made = out.emplace_back();
      made.vertex = v;
      note_ring(made.ring);
      find_far_neighbours(v, made.extra);
      collapse(v, static_cast<uint32_t>(target));
    }
    const size_t removed = out.size() - before;
    for (size_t i = before; i < out.size(); ++i)
      locked_[out[i].vertex] = UINT32_MAX;  // gone for good
    size_t kept = 0;
    for (const uint32_t v : alive_) {
      alive_[kept] = v;
      kept += locked_[v] == UINT32_MAX ? 0 : 1;
    }
    alive_.resize(kept);
    return removed;
  }

  /// Leaves the neighbours of v in near_, nearest first, and none_ behind them.
  void take_near(uint32_t v) {
    near_count_ = neighbours_[v].size();
    const std::span<const uint32_t> list = neighbours_.by_eights(v);
    near_.fill(none_);
    std::copy(list.begin(), list.end(), near_.begin());
    sort_by_distance(v, near_.data(), near_count_);
  }
  std::span<const uint32_t> near() const { return std::span(near_).first(near_count_); }
  std::span<const uint32_t> near_by_eights() const {
    return std::span(near_).first(by_eights(near_count_));
  }

  /// Locks the vertices in near_, by index the ring.
  void note_ring(FixedList<uint32_t, 16>& ring) {
    std::array<int32_t, 16> keys;
    for (size_t i = 0; i < near_by_eights().size(); ++i) {
      keys[i] = i < near_count_ ? static_cast<int32_t>(near_[i]) : kNoKey;
      locked_[near_[i]] = level_;
    }
    std::copy(near_.begin(), near_.end(), ring.begin());
    sort_few(keys.data(), ring.begin(), near_count_);
    ring.resize(near_count_);
  }

  /// There is room for `vertices` by eights.
  void sort_by_distance(uint32_t v, uint32_t* vertices, size_t count) const {
    if (count <= kFew) {
      std::array<int32_t, kFew> keys;
      uint64_t bits = 0;
      for (size_t i = 0; i < by_eights(count); ++i) {
        const uint64_t distance2 = points_.distance2(v, i < count ? vertices[i] : v);
        keys[i] = i < count ? static_cast<int32_t>(distance2) : kNoKey;
        bits |= distance2;
      }
      if (bits < kNoKey && sort_few(keys.data(), vertices, count)) return;
    }
    std::sort(vertices, vertices + count, [&](uint32_t a, uint32_t b) {
      return std::pair(points_.distance2(v, a), a) < std::pair(points_.distance2(v, b), b);
    });
  }

  /// Nearest neighbour that v can be merged into without changing the topology; -1 if there is
  /// none. Pre-condition: near_ holds the neighbours of v, nearest first.
  int64_t choose_target(uint32_t v) {
    mark(near_by_eights());
    const std::span<const uint32_t> faces = faces_[v];
    const ptrdiff_t wanted = faces.empty() ? 0 : faces.size() == near_count_ ? 2 : 1;
    for (const uint32_t u : near()) {
      if (neighbours_[u].size() + near_count_ > kMaxMerged + 4) continue;
      if (near_count_ <= 2) return u;  // a dangling end, nothing to protect
      const std::span<const uint32_t> others = neighbours_.by_eights(u);
      const auto common =
          std::count_if(others.begin(), others.end(), [&](uint32_t w) { return marked(w); });
      const auto shared = std::count_if(faces.begin(), faces.end(),
                                        [&](uint32_t f) { return has(triangles_[f], u); });
      if (common == wanted && shared == wanted) return u;
    }
    return -1;
  }

  // What follows goes without branches on what the mesh looks like: they are hard to foresee.
  static uint32_t same(uint32_t a, uint32_t b) { return a == b ? 1 : 0; }
  static bool has(const Triangle& t, uint32_t v) {
    return (same(t[0], v) | same(t[1], v) | same(t[2], v)) != 0;
  }

  /// Leaves in far_ the neighbours of `from`, at most kMaxFrom, that are not marked, and marks
  /// them.
  void find_next_ring(std::span<const uint32_t> from) {
    const auto is_new = marker(stamp_);
    size_t size = 0;
    for (const uint32_t w : from) {
      for (const uint32_t u : neighbours_.by_eights(w)) {
        far_[size] = u;
        size += is_new(u) ? 1 : 0;
      }
    }
    far_count_ = size;
  }

  /// The nearest of the second ring, then of the third. Pre-condition: near_ and its marks as
  /// choose_target leaves them.
  void find_far_neighbours(uint32_t v, FixedList<uint32_t, 16>& extra) {
    seen_[v] = seen_[none_] = stamp_;
    find_next_ring(near());
    add_nearest_far(v, extra);
    if (extra.size() == max_extra_) return;
    const FixedList<uint32_t, 16> second = extra;
    find_next_ring(std::span(second.begin(), second.size()));
    add_nearest_far(v, extra);
  }
  void add_nearest_far(uint32_t v, FixedList<uint32_t, 16>& extra) {
    sort_by_distance(v, far_.data(), far_count_);
    const size_t count = std::min(far_count_, max_extra_ - extra.size());
    std::copy_n(far_.begin(), count, extra.end());
    extra.resize(extra.size() + count);
  }

  /// Pre-condition: near_ holds the neighbours of v.
  void collapse(uint32_t v, uint32_t target) {
    move_faces(v, target);
    mark(neighbours_.by_eights(target));
    for (const uint32_t w : near()) {
      const bool erases = (same(w, target) | same(seen_[w], stamp_)) != 0;
      neighbours_.replace_or_erase(w, v, target, erases);
      neighbours_.push_back_if(!erases, target, w);
      const uint32_t added = erases ? 0 : points_.distance_q4(w, target);
      edges_[w] += added - points_.distance_q4(w, v);
      edges_[target] += added;
    }
  }

  /// The target takes the place of v in its triangles; those that it has are gone.
  void move_faces(uint32_t v, uint32_t target) {
    const std::span<const uint32_t> faces = faces_[v];
    around_.resize(std::max(around_.size(), 2 * faces.size()));
    uint32_t* const moved = around_.data();
    uint32_t* const gone = moved + faces.size();
    size_t moved_count = 0, gone_count = 0;
    for (const uint32_t f : faces) {
      Triangle& t = triangles_[f];
      const uint32_t keeps = has(t, target) ? 0 : 1;
      for (uint32_t& corner : t) {
        const uint32_t moves = keeps & same(corner, v);
        corner ^= (corner ^ target) & (0u - moves);
      }
      moved[moved_count] = gone[gone_count] = f;
      moved_count += keeps;
      gone_count += 1 - keeps;
    }
    for (size_t i = 0; i < moved_count; ++i) faces_.push_back(target, moved[i]);
    for (size_t i = 0; i < gone_count; ++i) {
      for (const uint32_t w : triangles_[gone[i]]) faces_.erase(w, gone[i]);
    }
  }

  const GridPoints& points_;
  uint32_t max_extra_;
  uint32_t none_;  ///< beyond all vertices
  NeighbourLists neighbours_;
  NeighbourLists faces_;
  std::vector<Triangle> triangles_;
  Indices edges_;  ///< of every vertex, the lengths of its edges in all: below 2^30
  Indices alive_;
  Indices seen_;  ///< stamp_ for what is marked
  uint32_t stamp_ = 0;
  Indices locked_;  ///< level at which the vertex must stay
  uint32_t level_ = 0;
  std::array<uint32_t, 16> near_;  ///< neighbours of the vertex at hand, nearest first
  size_t near_count_ = 0;
  Indices far_;  ///< others near it, the first far_count_
  size_t far_count_ = 0;
  Indices around_;  ///< its triangles
  std::vector<uint64_t> keys_, sorted_;
};

}  // namespace

CollapseSequence collapse_mesh(const GridPoints& points, std::span<const uint32_t> triangles,
                               uint32_t max_extra) {
  return Collapser(points, triangles, max_extra).run();
}

}  // namespace reeb
