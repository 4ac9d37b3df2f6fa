#include "codec/common/fast/contraction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "codec/common/base/batches.h"
#include "codec/common/prediction/coarsening.h"

namespace reeb {

namespace {

constexpr uint32_t kBaseNeighbours = 4;
constexpr uint32_t kMaxAround = 12;  ///< neighbours of a row: more gain little and take time

constexpr uint32_t kNoTarget = UINT32_MAX;

/// The neighbours of a vertex, in a cache line; from the last one on there is what stands for none.
struct alignas(64) Around {
  uint32_t vertex[kMaxNeighbours];

  /// Place of v, or kMaxNeighbours. Looks at all places at once, since a loop that ends early takes
  /// longer for the processor's wrong guess of where.
  uint32_t find(uint32_t v) const {
#if defined(__SSE2__)
    const auto* at = reinterpret_cast<const __m128i*>(vertex);
    const __m128i wanted = _mm_set1_epi32(static_cast<int>(v));
    __m128i same[4];
    for (int i = 0; i < 4; ++i) same[i] = _mm_cmpeq_epi32(_mm_load_si128(at + i), wanted);
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
};

/// How many neighbours a vertex has. One that was to have more than there is room for is full: it
/// stays to the end.
struct Valence {
  uint8_t size = 0;
  bool full = false;
};

/// What follows goes without branches on what the mesh looks like: they are hard to foresee.
class Contraction {
 public:
  Contraction(uint32_t vertex_count, std::span<const uint32_t> triangles)
      : none_(vertex_count),
        around_(vertex_count),
        valence_(vertex_count),
        locked_(vertex_count, 0),
        met_(vertex_count + 1, 0) {
    for (Around& a : around_) std::fill(std::begin(a.vertex), std::end(a.vertex), none_);
    for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
      for (size_t j = 0; j < 3; ++j)
        add(triangles[i + j], triangles[i + (j + 1) % 3], triangles[i + (j + 2) % 3]);
    }
  }

  SurfaceGraph run(const StopToken& stop) {
    std::vector<uint32_t> isolated;
    for (uint32_t v = 0; v < none_; ++v) (valence_[v].size == 0 ? isolated : alive_).push_back(v);
    out_.graph.rows.resize(none_);
    first_free_ = static_cast<uint32_t>(alive_.size());
    TryBudget budget(alive_.size());
    while (alive_.size() > kBaseSize && budget.take(alive_.size())) {
      stop.check();
      const size_t before = alive_.size();
      run_sweep();
      if (!worth_another_sweep(before - alive_.size(), alive_.size())) break;
    }
    return collect(isolated);
  }

 private:
  /// Makes two vertices, which are different, neighbours of v.
  void add(uint32_t v, uint32_t first, uint32_t second) {
    Around& a = around_[v];
    Valence& valence = valence_[v];
    const bool has_second = a.has(second);
    for (const auto& [u, has] : {std::pair(first, a.has(first)), std::pair(second, has_second)}) {
      if (has) continue;
      if (valence.size < kMaxNeighbours) {
        a.vertex[valence.size++] = u;
      } else {
        valence.full = true;
      }
    }
  }

  void run_sweep() {
    ++sweep_;
    std::erase_if(alive_, [&](uint32_t v) {
      const Valence valence = valence_[v];
      if (locked_[v] == sweep_ || valence.full || valence.size == 0 || valence.size > kMaxValence)
        return false;
      const uint32_t target = choose_target(around_[v], valence.size);
      if (target == kNoTarget) return false;
      note(v);
      for (uint32_t i = 0; i < valence.size; ++i) locked_[around_[v].vertex[i]] = sweep_;
      contract(v, target);
      return true;
    });
  }

  /// The neighbour with the fewest neighbours, the first of those, where the vertex may go.
  uint32_t choose_target(const Around& ring, uint32_t size) const {
    uint32_t best = kNoTarget;
    uint32_t least = kMaxNeighbours + 1 - size;
    for (uint32_t i = 0; i < size; ++i) {
      const Valence valence = valence_[ring.vertex[i]];
      const bool fewer = !valence.full && valence.size < least;
      best = fewer ? ring.vertex[i] : best;
      least = fewer ? valence.size : least;
    }
    return best;
  }

  /// Makes the row of v, which is removed: its ring, then the neighbours of those, first the ones
  /// that two or more of them share. For now, neighbours are vertices.
  void note(uint32_t v) {
    const Around& ring = around_[v];
    const uint32_t size = valence_[v].size;
    PredictionGraph::Row& row = out_.graph.rows[--first_free_];
    row.ring = static_cast<uint8_t>(size);
    row.neighbour = std::to_array(ring.vertex);
    mark_ += 2;  // met once: mark_; met again, or not wanted: mark_ + 1
    met_[v] = met_[none_] = mark_ + 1;
    for (uint32_t i = 0; i < size; ++i) met_[ring.vertex[i]] = mark_ + 1;
    uint32_t once[kMaxValence * kMaxNeighbours];
    uint32_t once_count = 0;
    uint32_t count = size;
    const auto meet = [&](uint32_t u) {
      const uint32_t met = met_[u];
      once[once_count] = u;
      once_count += met < mark_ ? 1 : 0;
      row.neighbour[count] = u;
      count += met == mark_ && count < kMaxAround ? 1 : 0;
      met_[u] = met < mark_ ? mark_ : mark_ + 1;
    };
    constexpr uint32_t kUsual = 8;
    for (uint32_t i = 0; i < size; ++i) {
      const Around& a = around_[ring.vertex[i]];
      for (uint32_t j = 0; j < kUsual; ++j) meet(a.vertex[j]);
      for (uint32_t j = kUsual; j < valence_[ring.vertex[i]].size; ++j) meet(a.vertex[j]);
    }
    for (uint32_t i = 0; i < once_count; ++i) {
      row.neighbour[count] = once[i];
      count += met_[once[i]] == mark_ && count < kMaxAround ? 1 : 0;
    }
    row.count = static_cast<uint8_t>(count);
    removed_.push_back(v);
  }

  void contract(uint32_t v, uint32_t target) {
    const Around ring = around_[v];
    const Around before = around_[target];  // to which nothing is added that it has
    uint32_t merged[kMaxValence];
    uint32_t merged_count = 0;
    for (uint32_t i = 0; i < valence_[v].size; ++i) {
      const uint32_t w = ring.vertex[i];
      replace(w, v, target);
      merged[merged_count] = w;
      merged_count += w != target && !before.has(w) ? 1 : 0;
    }
    // There is room: choose_target sees to it.
    std::copy_n(merged, merged_count, &around_[target].vertex[valence_[target].size]);
    valence_[target].size = static_cast<uint8_t>(valence_[target].size + merged_count);
    valence_[v].size = 0;
  }

  /// In the list of w, v gives way to the target; where that is there or is w, to nothing.
  void replace(uint32_t w, uint32_t v, uint32_t target) {
    Around& a = around_[w];
    const uint32_t at = a.find(v);
    const bool erase = w == target || a.has(target);
    if (at == kMaxNeighbours) return;
    uint32_t& last = a.vertex[valence_[w].size - 1];
    a.vertex[at] = erase ? last : target;
    last = erase ? none_ : last;
    valence_[w].size = static_cast<uint8_t>(valence_[w].size - (erase ? 1 : 0));
  }

  /// Rows: what is left, what was removed in reverse, what has no neighbours.
  SurfaceGraph collect(const std::vector<uint32_t>& isolated) {
    out_.order = alive_;
    out_.order.insert(out_.order.end(), removed_.rbegin(), removed_.rend());
    out_.order.insert(out_.order.end(), isolated.begin(), isolated.end());
    std::vector<uint32_t> row_of(none_);
    for (uint32_t r = 0; r < none_; ++r) row_of[out_.order[r]] = r;
    out_.graph.step_index.resize(none_, 0);
    for (uint32_t r = 0; r < none_; ++r) {
      PredictionGraph::Row& row = out_.graph.rows[r];
      if (r - alive_.size() < removed_.size()) {
        for (uint32_t i = 0; i < row.count; ++i) row.neighbour[i] = row_of[row.neighbour[i]];
      } else {
        follow(r, row);
      }
      std::fill(row.neighbour.begin() + row.count, row.neighbour.end(), r);
    }
    return std::move(out_);
  }

  /// A row that nothing surrounds goes by the rows before it.
  static void follow(uint32_t r, PredictionGraph::Row& row) {
    row.count = static_cast<uint8_t>(std::min(r, kBaseNeighbours));
    row.ring = std::min<uint8_t>(row.count, 1);
    for (uint32_t i = 0; i < row.count; ++i) row.neighbour[i] = r - 1 - i;
  }

  uint32_t none_;  ///< beyond all vertices
  BatchVector<Around> around_;
  std::vector<Valence> valence_;
  std::vector<uint32_t> removed_;
  std::vector<uint32_t> alive_;
  std::vector<uint32_t> locked_;  ///< sweep in which the vertex must stay
  std::vector<uint32_t> met_;
  SurfaceGraph out_;
  uint32_t first_free_ = 0;  ///< the rows from here on are complete
  uint32_t sweep_ = 0;
  uint32_t mark_ = 0;
};

}  // namespace

SurfaceGraph contract_mesh(uint32_t vertex_count, std::span<const uint32_t> triangles,
                           const StopToken& stop) {
  return Contraction(vertex_count, triangles).run(stop);
}

}  // namespace reeb
