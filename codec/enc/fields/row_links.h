// Which rows of a graph lie next to each other, whichever of them predicts the other.
#pragma once

#include "codec/common/base/item_lists.h"
#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

/// Rows joined by a ring in either direction, of each row.
using RowLinks = ItemLists<uint32_t>;
RowLinks link_rings(const PredictionGraph& graph);

}  // namespace reeb
