#include "codec/common/contraction.h"

#include <algorithm>
#include <bit>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace reeb {

namespace {

constexpr uint32_t kBaseSize = 64;      ///< stop at this many vertices
constexpr uint32_t kMaxValence = 9;     ///< of a removed vertex
constexpr uint32_t kMinProgress = 200;  ///< stop when a level removes fewer than one in this many
constexpr uint32_t kBaseNeighbours = 4;
constexpr uint32_t kMostAround = 12;  ///< neighbours of a row: more gain little and take time

constexpr uint32_t kNone = UINT32_MAX;

/// The neighbours of a vertex. One that has more than there is room for stays to the end.
struct Around {
  uint32_t size = 0;
  bool full = false;
  uint32_t vertex[kMaxNeighbours];  ///< kNone from `size` on

  Around() { std::fill(std::begin(vertex), std::end(vertex), kNone); }
  /// Place of v, or kMaxNeighbours. Looks at all places at once, since a loop that ends early takes
  /// longer for the processor's wrong guess of where.
  uint32_t find(uint32_t v) const {
#if defined(__SSE2__)
    const auto* at = reinterpret_cast<const __m128i*>(vertex);
    const __m128i wanted = _mm_set1_epi32(static_cast<int>(v));
    __m128i same[4];
    for (int i = 0; i < 4; ++i) same[i] = _mm_cmpeq_epi32(_mm_loadu_si128(at + i), wanted);
    const __m128i bytes =
        _mm_packs_epi16(_mm_packs_epi32(same[0], same[1]), _mm_packs_epi32(same[2], same[3]));
    const auto found = static_cast<uint32_t>(_mm_movemask_epi8(bytes));
    static_assert(kMaxNeighbours == 16);
#else
    uint32_t found = 0;
    for (uint32_t i = 0; i < kMaxNeighbours; ++i) found |= uint32_t{vertex[i] == v} << i;
#endif
    return static_cast<uint32_t>(std::countr_zero(found | 1u << kMaxNeighbours));
  }
  bool has(uint32_t v) const { return find(v) < kMaxNeighbours; }
  void add(uint32_t v) {
    if (has(v)) return;
    if (size == kMaxNeighbours) {
      full = true;
    } else {
      vertex[size++] = v;
    }
  }
  void erase(uint32_t i) {
    vertex[i] = vertex[--size];
    vertex[size] = kNone;
  }
};

/// A vertex that was removed, and what surrounded it, ring first.
struct Removed {
  uint32_t vertex;
  uint8_t ring, count;
  uint32_t neighbour[kMostAround + 1];  ///< the last place takes what there is no room for
};

class Contraction {
 public:
  Contraction(uint32_t vertex_count, std::span<const uint32_t> triangles)
      : around_(vertex_count), locked_(vertex_count, 0), met_(vertex_count, 0) {
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
      for (size_t j = 0; j < 3; ++j) {
        around_[triangles[i + j]].add(triangles[i + (j + 1) % 3]);
        around_[triangles[i + j]].add(triangles[i + (j + 2) % 3]);
      }
    }
  }

  SurfaceGraph run() {
    std::vector<uint32_t> isolated;
    for (uint32_t v = 0; v < around_.size(); ++v)
      (around_[v].size == 0 ? isolated : alive_).push_back(v);
    removed_.reserve(around_.size());
    while (alive_.size() > kBaseSize) {
      const size_t before = alive_.size();
      run_level();
      if (before - alive_.size() < std::max<size_t>(1, alive_.size() / kMinProgress)) break;
    }
    return collect(isolated);
  }

 private:
  void run_level() {
    ++level_;
    std::erase_if(alive_, [&](uint32_t v) {
      const Around& ring = around_[v];
      if (locked_[v] == level_ || ring.full || ring.size == 0 || ring.size > kMaxValence)
        return false;
      const uint32_t target = choose_target(ring);
      if (target == kNone) return false;
      note(v);
      for (uint32_t i = 0; i < ring.size; ++i) locked_[ring.vertex[i]] = level_;
      contract(v, target);
      return true;
    });
  }

  /// The neighbour with the fewest neighbours, the first of those, where the vertex may go.
  uint32_t choose_target(const Around& ring) const {
    uint32_t best = kNone;
    uint32_t least = kMaxNeighbours + 1 - ring.size;
    for (uint32_t i = 0; i < ring.size; ++i) {
      const Around& a = around_[ring.vertex[i]];
      if (a.full || a.size >= least) continue;
      best = ring.vertex[i];
      least = a.size;
    }
    return best;
  }

  /// Keeps what surrounds v: its ring, then the neighbours of those, first the ones that two or
  /// more of them share. Whether a neighbour was met is hard to foresee, hence no branches on it.
  void note(uint32_t v) {
    const Around& ring = around_[v];
    Removed& out = removed_.emplace_back();
    out.vertex = v;
    out.ring = static_cast<uint8_t>(ring.size);
    std::copy_n(ring.vertex, ring.size, out.neighbour);
    mark_ += 2;  // met once: mark_; met again, or not wanted: mark_ + 1
    met_[v] = mark_ + 1;
    for (uint32_t i = 0; i < ring.size; ++i) met_[ring.vertex[i]] = mark_ + 1;
    uint32_t once[kMaxValence * kMaxNeighbours];
    uint32_t once_count = 0;
    uint32_t count = ring.size;
    for (uint32_t i = 0; i < ring.size; ++i) {
      const Around& a = around_[ring.vertex[i]];
      for (uint32_t j = 0; j < a.size; ++j) {
        const uint32_t u = a.vertex[j];
        const uint32_t met = met_[u];
        once[once_count] = u;
        once_count += met < mark_ ? 1 : 0;
        out.neighbour[count] = u;
        count += met == mark_ && count < kMostAround ? 1 : 0;
        met_[u] = met < mark_ ? mark_ : mark_ + 1;
      }
    }
    for (uint32_t i = 0; i < once_count; ++i) {
      out.neighbour[count] = once[i];
      count += met_[once[i]] == mark_ && count < kMostAround ? 1 : 0;
    }
    out.count = static_cast<uint8_t>(count);
  }

  void contract(uint32_t v, uint32_t target) {
    Around& ring = around_[v];
    Around& merged = around_[target];
    for (uint32_t i = 0; i < ring.size; ++i) {
      Around& a = around_[ring.vertex[i]];
      const uint32_t at = a.find(v);
      if (ring.vertex[i] == target || a.has(target)) {
        if (at < a.size) a.erase(at);
      } else if (at < a.size) {
        a.vertex[at] = target;
      }
      if (ring.vertex[i] != target) merged.add(ring.vertex[i]);
    }
    ring = {};
  }

  /// Rows: what is left, what was removed in reverse, what has no neighbours.
  SurfaceGraph collect(const std::vector<uint32_t>& isolated) {
    SurfaceGraph out;
    out.order = alive_;
    for (size_t i = removed_.size(); i-- > 0;) out.order.push_back(removed_[i].vertex);
    out.order.insert(out.order.end(), isolated.begin(), isolated.end());
    std::vector<uint32_t> rank(out.order.size());
    for (uint32_t r = 0; r < rank.size(); ++r) rank[out.order[r]] = r;
    out.graph.rows.resize(rank.size());
    out.graph.step_level.resize(rank.size(), 0);
    for (uint32_t r = 0; r < rank.size(); ++r) {
      PredictionGraph::Row& row = out.graph.rows[r];
      const size_t from_first = r - alive_.size();
      if (from_first < removed_.size()) {
        const Removed& from = removed_[removed_.size() - 1 - from_first];
        row.ring = from.ring;
        row.count = from.count;
        for (uint32_t i = 0; i < row.count; ++i) row.neighbour[i] = rank[from.neighbour[i]];
      } else {
        follow(r, row);
      }
      std::fill(row.neighbour.begin() + row.count, row.neighbour.end(), r);
    }
    return out;
  }

  /// A row that nothing surrounds goes by the rows before it.
  static void follow(uint32_t r, PredictionGraph::Row& row) {
    row.count = static_cast<uint8_t>(std::min(r, kBaseNeighbours));
    row.ring = std::min<uint8_t>(row.count, 1);
    for (uint32_t i = 0; i < row.count; ++i) row.neighbour[i] = r - 1 - i;
  }

  std::vector<Around> around_;
  std::vector<Removed> removed_;
  std::vector<uint32_t> alive_;
  std::vector<uint32_t> locked_;  ///< level at which the vertex must stay
  std::vector<uint32_t> met_;
  uint32_t level_ = 0;
  uint32_t mark_ = 0;
};

}  // namespace

SurfaceGraph contract_mesh(uint32_t vertex_count, std::span<const uint32_t> triangles) {
  return Contraction(vertex_count, triangles).run();
}

}  // namespace reeb
