#include "codec/enc/fields/row_links.h"

namespace reeb {

RowLinks link_rings(const PredictionGraph& graph) {
  RowLinks out;
  const uint32_t n = graph.size();
  out.begin.assign(n + 1, 0);
  for (uint32_t r = 0; r < n; ++r) {
    const PredictionGraph::Row& row = graph.rows[r];
    out.begin[r + 1] += row.ring;
    for (uint32_t i = 0; i < row.ring; ++i) ++out.begin[row.neighbour[i] + 1];
  }
  for (uint32_t r = 0; r < n; ++r) out.begin[r + 1] += out.begin[r];
  out.links.resize(out.begin[n]);
  std::vector<uint32_t> next(out.begin.begin(), out.begin.end() - 1);
  for (uint32_t r = 0; r < n; ++r) {
    const PredictionGraph::Row& row = graph.rows[r];
    for (uint32_t i = 0; i < row.ring; ++i) {
      out.links[next[r]++] = row.neighbour[i];
      out.links[next[row.neighbour[i]]++] = r;
    }
  }
  return out;
}

}  // namespace reeb
