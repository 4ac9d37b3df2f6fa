// Which rows of a graph lie next to each other, whichever of them predicts the other.
#pragma once

#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

/// Rows joined by a ring in either direction; row r has links[begin[r] .. begin[r+1]).
struct RowLinks {
  std::vector<uint32_t> begin;
  std::vector<uint32_t> links;
};
RowLinks link_rings(const PredictionGraph& graph);

}  // namespace reeb
