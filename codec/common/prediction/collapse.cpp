#include "codec/common/prediction/collapse.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

#include "codec/common/base/sort_few.h"
#include "codec/common/prediction/coarsening.h"
#include "codec/common/prediction/collapsing_mesh.h"

namespace reeb {

namespace {

constexpr uint32_t kMaxMerged = 12;  ///< valence that a collapse may give to its target
/// Common neighbours of the ends of an edge, which are left out of the count.
constexpr uint32_t kCommon = 4;
constexpr size_t kMaxNear = 16;

using Indices = std::vector<uint32_t>;

/// The neighbours of a vertex, nearest first; what stands for none behind them.
struct Near {
  std::array<uint32_t, kMaxNear> vertex;
  size_t count = 0;

  std::span<const uint32_t> list() const { return std::span(vertex).first(count); }
  std::span<const uint32_t> by_eights() const {
    return std::span(vertex).first(reeb::by_eights(count));
  }
};

/// Sorts vertices by their distance from v, equal ones by index. There is room by eights.
void sort_by_distance(const GridPoints& points, uint32_t v, uint32_t* vertices, size_t count) {
  if (count <= kFew) {
    std::array<int32_t, kFew> keys;
    uint64_t bits = 0;
    for (size_t i = 0; i < by_eights(count); ++i) {
      const uint64_t distance2 = points.distance2(v, i < count ? vertices[i] : v);
      keys[i] = i < count ? static_cast<int32_t>(distance2) : kNoKey;
      bits |= distance2;
    }
    if (bits < kNoKey && sort_few(keys.data(), vertices, count)) return;
  }
  std::sort(vertices, vertices + count, [&](uint32_t a, uint32_t b) {
    return std::pair(points.distance2(v, a), a) < std::pair(points.distance2(v, b), b);
  });
}

/// Vertices by their mean edge, equal ones in the order they come in. By radix.
class EdgeOrder {
 public:
  /// `vertices` rise.
  const std::vector<uint64_t>& sort(const Indices& vertices, const CollapsingMesh& mesh) {
    Counts low{}, high{};
    keys_.clear();
    for (const uint32_t v : vertices) {
      const uint64_t mean = mesh.mean_edge(v);
      keys_.push_back(mean << 32 | v);
      ++low[mean % kDigits];
      ++high[mean >> kDigitBits];
    }
    sort_by_digit(32, low);
    sort_by_digit(32 + kDigitBits, high);
    return keys_;
  }

 private:
  static constexpr uint32_t kDigitBits = 11;  // two digits are enough for the longest edge
  static constexpr uint32_t kDigits = 1u << kDigitBits;
  using Counts = std::array<uint32_t, kDigits>;

  /// Stably, by the digit from bit `shift` on.
  void sort_by_digit(uint32_t shift, Counts& begin) {
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0u);
    sorted_.resize(keys_.size());
    for (const uint64_t key : keys_) sorted_[begin[(key >> shift) % kDigits]++] = key;
    keys_.swap(sorted_);
  }

  std::vector<uint64_t> keys_, sorted_;
};

/// Half-edge collapses, sweep after sweep: in each, vertices with short edges first, none next to
/// one that was removed, and none whose removal would change the topology.
class Collapser {
 public:
  Collapser(const GridPoints& points, std::span<const uint32_t> triangles, uint32_t max_extra)
      : points_(points),
        max_extra_(max_extra),
        mesh_(points, triangles, kMaxMerged / 2),
        seen_(points.size() + 1),
        locked_(points.size() + 1, 0) {
    size_t longest = kMaxMerged + kCommon;
    for (uint32_t v = 0; v < points.size(); ++v)
      longest = std::max(longest, mesh_.neighbours_by_eights(v).size());
    far_.resize(by_eights(kMaxNear * longest + 1));
  }

  CollapseSequence run(const StopToken& stop) {
    CollapseSequence out;
    for (uint32_t v = 0; v < points_.size(); ++v)
      (mesh_.valence(v) == 0 ? out.isolated : alive_).push_back(v);
    out.collapses.reserve(alive_.size());
    TryBudget budget(alive_.size());
    while (alive_.size() > kBaseSize && budget.take(alive_.size())) {
      const size_t removed = run_sweep(stop, out.collapses);
      if (!worth_another_sweep(removed, alive_.size())) break;
    }
    out.base = std::move(alive_);
    return out;
  }

 private:
  size_t run_sweep(const StopToken& stop, std::vector<Collapse>& out) {
    ++sweep_;
    const size_t before = out.size();
    for (const uint64_t key : order_.sort(alive_, mesh_)) {
      stop.check();
      try_vertex(static_cast<uint32_t>(key), out);
    }
    for (size_t i = before; i < out.size(); ++i) locked_[out[i].vertex] = kGone;
    size_t kept = 0;
    for (const uint32_t v : alive_) {
      alive_[kept] = v;
      kept += locked_[v] == kGone ? 0 : 1;
    }
    alive_.resize(kept);
    return out.size() - before;
  }

  void try_vertex(uint32_t v, std::vector<Collapse>& out) {
    const uint32_t valence = mesh_.valence(v);
    if (locked_[v] == sweep_ || valence == 0 || valence > kMaxValence) return;
    take_near(v);
    const uint32_t target = choose_target(v);
    if (target == mesh_.none()) return;
    Collapse& made = out.emplace_back();
    made.vertex = v;
    note_ring(made.ring);
    note_extra(v, made.extra);
    mesh_.merge(v, near_.list(), target);
  }

  void take_near(uint32_t v) {
    const std::span<const uint32_t> list = mesh_.neighbours_by_eights(v);
    near_.count = mesh_.valence(v);
    near_.vertex.fill(mesh_.none());
    std::copy(list.begin(), list.end(), near_.vertex.begin());
    sort_by_distance(points_, v, near_.vertex.data(), near_.count);
  }

  /// The nearest neighbour that v can be merged into without changing the topology: the ends of the
  /// edge have those neighbours in common that their triangles have. None where there is none.
  /// Leaves the neighbours of v marked.
  uint32_t choose_target(uint32_t v) {
    seen_.clear();
    for (const uint32_t u : near_.by_eights()) seen_.mark(u);
    seen_.unmark(mesh_.none());
    const uint32_t faces = mesh_.face_count(v);
    const uint32_t wanted = faces == 0 ? 0 : faces == near_.count ? 2 : 1;
    for (const uint32_t u : near_.list()) {
      if (mesh_.valence(u) + near_.count > kMaxMerged + kCommon) continue;
      if (near_.count <= 2) return u;  // a dangling end, nothing to protect
      uint32_t common = 0;
      for (const uint32_t w : mesh_.neighbours_by_eights(u)) common += seen_.has(w) ? 1 : 0;
      if (common == wanted && mesh_.shared_faces(v, u) == wanted) return u;
    }
    return mesh_.none();
  }

  /// The neighbours by index, which are locked.
  void note_ring(FixedList<uint32_t, 16>& ring) {
    std::array<int32_t, kMaxNear> keys;
    for (size_t i = 0; i < near_.by_eights().size(); ++i) {
      keys[i] = i < near_.count ? static_cast<int32_t>(near_.vertex[i]) : kNoKey;
      locked_[near_.vertex[i]] = sweep_;
    }
    std::copy(near_.vertex.begin(), near_.vertex.end(), ring.begin());
    sort_few(keys.data(), ring.begin(), near_.count);
    ring.resize(near_.count);
  }

  /// The nearest of the second ring, then of the third. Pre-condition: marks as choose_target
  /// leaves them.
  void note_extra(uint32_t v, FixedList<uint32_t, 16>& extra) {
    seen_.mark(v);
    seen_.mark(mesh_.none());
    add_nearest(v, near_.list(), extra);
    if (extra.size() == max_extra_) return;
    const FixedList<uint32_t, 16> second = extra;
    add_nearest(v, std::span(second.begin(), second.size()), extra);
  }

  /// Of the neighbours of `from`, at most kMaxNear, that are not marked; marks them.
  void add_nearest(uint32_t v, std::span<const uint32_t> from, FixedList<uint32_t, 16>& extra) {
    size_t size = 0;
    for (const uint32_t w : from) {
      for (const uint32_t u : mesh_.neighbours_by_eights(w)) {
        far_[size] = u;
        size += seen_.add(u) ? 1 : 0;
      }
    }
    sort_by_distance(points_, v, far_.data(), size);
    const size_t count = std::min(size, max_extra_ - extra.size());
    std::copy_n(far_.begin(), count, extra.end());
    extra.resize(extra.size() + count);
  }

  static constexpr uint32_t kGone = UINT32_MAX;

  const GridPoints& points_;
  uint32_t max_extra_;
  CollapsingMesh mesh_;
  EdgeOrder order_;
  Indices alive_;
  MarkedVertices seen_;
  Indices locked_;  ///< sweep in which the vertex must stay; kGone for good
  uint32_t sweep_ = 0;
  Near near_;    ///< of the vertex at hand
  Indices far_;  ///< others near it
};

}  // namespace

CollapseSequence collapse_mesh(const GridPoints& points, std::span<const uint32_t> triangles,
                               uint32_t max_extra, const StopToken& stop) {
  return Collapser(points, triangles, max_extra).run(stop);
}

}  // namespace reeb
