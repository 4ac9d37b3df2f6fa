#include "codec/enc/fields/row_links.h"

namespace reeb {

RowLinks link_rings(const PredictionGraph& graph) {
  return RowLinks(graph.size(), [&](auto put) {
    for (uint32_t r = 0; r < graph.size(); ++r) {
      const PredictionGraph::Row& row = graph.rows[r];
      for (uint32_t i = 0; i < row.ring; ++i) {
        put(r, row.neighbour[i]);
        put(row.neighbour[i], r);
      }
    }
  });
}

}  // namespace reeb
