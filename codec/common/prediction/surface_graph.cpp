#include <algorithm>
#include <numeric>

#include "codec/common/base/coding_tools.h"
#include "codec/common/base/item_lists.h"
#include "codec/common/prediction/collapse.h"
#include "codec/common/prediction/nearest.h"
#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

namespace {

constexpr uint32_t kMaxExtra = 10;   ///< neighbours beyond the ring
constexpr uint32_t kEnough = 12;     ///< a row with fewer is completed by nearness in space
constexpr uint32_t kAloneRing = 4;   ///< ring of a vertex that has none on the surface
constexpr uint32_t kCoincident = 2;  ///< most vertices at the same place that join the ring
constexpr double kMinPrecision = 1 / 16.0;
constexpr double kMaxPrecision = 25;

/// The 16 bits of x spread to every third bit.
uint64_t spread_bits(uint32_t x) {
  uint64_t out = 0;
  for (int i = 0; i < 16; ++i) out |= uint64_t{x >> i & 1} << (3 * i);
  return out;
}

uint64_t morton_code(const int32_t* p) {
  return spread_bits(static_cast<uint32_t>(p[0])) | spread_bits(static_cast<uint32_t>(p[1])) << 1 |
         spread_bits(static_cast<uint32_t>(p[2])) << 2;
}

/// Coarse to fine along a space-filling curve: every 2^j-th of its vertices before the ones in
/// between.
void append_by_strides(const GridPoints& points, std::vector<uint32_t> vertices,
                       std::vector<uint32_t>& order) {
  std::sort(vertices.begin(), vertices.end(), [&](uint32_t a, uint32_t b) {
    return std::pair(morton_code(points[a]), a) < std::pair(morton_code(points[b]), b);
  });
  const size_t n = vertices.size();
  if (n == 0) return;
  order.push_back(vertices[0]);
  for (size_t stride = std::bit_ceil(n); stride >= 1; stride /= 2) {
    for (size_t i = stride; i < n; i += 2 * stride) order.push_back(vertices[i]);
  }
}

/// Neighbours of one vertex as they are gathered, ring first.
struct Gathered {
  FixedList<uint32_t, 16> ring;
  FixedList<uint32_t, 16> extra;

  size_t size() const { return ring.size() + extra.size(); }
  bool has(uint32_t v) const {
    return std::find(ring.begin(), ring.end(), v) != ring.end() ||
           std::find(extra.begin(), extra.end(), v) != extra.end();
  }
};

class SurfaceGraphBuilder {
 public:
  SurfaceGraphBuilder(const GridPoints& points, std::span<const uint32_t> triangles,
                      const StopToken& stop)
      : points_(points),
        stop_(stop),
        sequence_(collapse_mesh(points, triangles, kMaxExtra, stop)),
        boundary_(points.size(), false) {
    order_.reserve(points.size());
    append_by_strides(points, sequence_.base, order_);
    const auto& collapses = sequence_.collapses;
    for (size_t i = collapses.size(); i-- > 0;) order_.push_back(collapses[i].vertex);
    append_by_strides(points, sequence_.isolated, order_);
    row_of_.resize(points.size());
    for (uint32_t r = 0; r < order_.size(); ++r) row_of_[order_[r]] = r;
    mark_boundary(triangles);
  }

  SurfaceGraph build() {
    EarlierNeighbours nearest(points_, order_, row_of_);
    SurfaceGraph out;
    out.graph.rows.resize(points_.size());
    for (uint32_t r = 0; r < order_.size(); ++r) {
      stop_.check();
      Gathered gathered = gather(r);
      complete(order_[r], nearest, gathered);
      fill_row(r, gathered, out.graph.rows[r]);
    }
    out.order = std::move(order_);
    weigh_rows(points_, out);
    return out;
  }

 private:
  /// Vertices on an edge of one triangle: others may lie at the same place,
  /// moving alike.
  void mark_boundary(std::span<const uint32_t> triangles) {
    const ItemLists<uint32_t> higher_ends(points_.size(), [&](auto put) {
      for (size_t i = 0; i < triangles.size(); ++i) {
        const auto [low, high] = std::minmax(triangles[i], triangles[i % 3 == 2 ? i - 2 : i + 1]);
        put(low, high);
      }
    });
    std::vector<uint32_t> count(points_.size(), 0);  // of the edges between v and each
    for (size_t v = 0; v < points_.size(); ++v) {
      const std::span<const uint32_t> edges = higher_ends[v];
      for (const uint32_t u : edges) ++count[u];
      for (const uint32_t u : edges) {
        if (count[u] == 1) boundary_[v] = boundary_[u] = true;
      }
      for (const uint32_t u : edges) count[u] = 0;
    }
  }

  /// What the collapses tell.
  Gathered gather(uint32_t r) const {
    const size_t place = r - sequence_.base.size();  // wraps around for the base
    const size_t count = sequence_.collapses.size();
    if (place >= count) return {};
    const Collapse& c = sequence_.collapses[count - 1 - place];
    return {c.ring, c.extra};
  }

  void complete(uint32_t v, EarlierNeighbours& nearest, Gathered& g) const {
    const bool alone = g.ring.empty();
    if (!alone && !boundary_[v] && g.size() >= kEnough) return;
    uint32_t coincident = 0;
    for (const uint32_t u : nearest.find(v, kMaxNeighbours)) {
      if (g.has(u)) continue;
      if (alone && g.ring.size() < kAloneRing) {
        g.ring.push_back(u);
      } else if (points_.distance2(v, u) == 0 && coincident < kCoincident) {
        g.ring.push_front(u);
        ++coincident;
      } else if (g.size() < kMaxNeighbours) {
        g.extra.push_back(u);
      }
    }
  }

  void fill_row(uint32_t r, const Gathered& g, PredictionGraph::Row& row) const {
    row.neighbour.fill(r);
    row.ring = static_cast<uint8_t>(std::min<size_t>(g.ring.size(), kMaxNeighbours));
    const size_t wanted = uses(coding_tool::kExtraNeighbours) ? g.size() : g.ring.size();
    row.count = static_cast<uint8_t>(std::min<size_t>(wanted, kMaxNeighbours));
    for (uint32_t i = 0; i < row.count; ++i)
      row.neighbour[i] = row_of_[i < g.ring.size() ? g.ring[i] : g.extra[i - g.ring.size()]];
  }

  const GridPoints& points_;
  const StopToken& stop_;
  CollapseSequence sequence_;
  std::vector<bool> boundary_;
  std::vector<uint32_t> order_;
  std::vector<uint32_t> row_of_;
};

/// The nearer a neighbour of the ring, the more it is expected to count, as 1 / distance; the
/// farther a neighbour, the surer it counts for little: precision grows with the distance in the
/// ring and with its square beyond, the mean distance of the ring being 1.
void weigh_row(const GridPoints& points, const std::vector<uint32_t>& order, uint32_t r,
               PredictionGraph::Row& row) {
  uint32_t distance[kMaxNeighbours] = {};  // in 1/16 grid units, at least a quarter of the grid
  uint32_t inverse[kMaxNeighbours] = {};
  uint32_t sum = 0;
  uint64_t inverse_sum = 0;
  for (uint32_t i = 0; i < row.count; ++i) {
    distance[i] = std::max(4u, points.distance_q4(order[r], order[row.neighbour[i]]));
    if (i >= row.ring) continue;
    sum += distance[i];
    inverse_sum += inverse[i] = (1u << 22) / distance[i];
  }
  row.prior.fill(0.0f);
  row.precision.fill(1.0f);
  if (inverse_sum == 0) return;  // without a ring there are no neighbours
  for (uint32_t i = 0; i < row.ring; ++i) {
    const uint64_t share = (uint64_t{inverse[i]} << 16) / inverse_sum;
    row.prior[i] = static_cast<float>(share) / 65536.0f;
  }
  for (uint32_t i = 0; i < row.count; ++i) {
    const double ratio = static_cast<double>(distance[i]) * row.ring / sum;
    const double precision = i < row.ring ? ratio : ratio * ratio;
    row.precision[i] = static_cast<float>(std::clamp(precision, kMinPrecision, kMaxPrecision));
  }
}

/// Prediction mass M (1 plus the prior-weighted mass of what the row predicts) in 1/256, then
/// step indices.
void assign_steps(PredictionGraph& graph) {
  std::vector<uint64_t> mass(graph.size(), 256);
  graph.step_index.resize(graph.size());
  if (!uses(coding_tool::kMassSteps)) return;
  for (uint32_t r = graph.size(); r-- > 0;) {
    const PredictionGraph::Row& row = graph.rows[r];
    for (uint32_t i = 0; i < row.ring; ++i) {
      const auto share = static_cast<uint64_t>(row.prior[i] * 65536.0f);
      mass[row.neighbour[i]] += mass[r] * share >> 16;
    }
    const uint32_t index = (log2_q5(mass[r]) - 8 * 32) / 4;
    graph.step_index[r] = static_cast<uint8_t>(std::min(index, kStepSizes - 1));
  }
}

}  // namespace

void weigh_rows(const GridPoints& points, SurfaceGraph& surface) {
  for (uint32_t r = 0; r < surface.graph.size(); ++r)
    weigh_row(points, surface.order, r, surface.graph.rows[r]);
  assign_steps(surface.graph);
}

SurfaceGraph build_surface_graph(const GridPoints& points, std::span<const uint32_t> triangles,
                                 const StopToken& stop) {
  if (points.size() == 0) return {};
  return SurfaceGraphBuilder(points, triangles, stop).build();
}

}  // namespace reeb
