// Cancellation of the small features of a Reeb graph.
#pragma once

#include <vector>

#include "segmentation/reeb_graph.h"

namespace reeb::segmentation {

struct SimplifiedGraph {
  struct Arc {
    uint32_t from, to;  ///< nodes; equal for an arc that returns to its node
    double from_value,
        to_value;   ///< of the function where the arc reached its nodes before any contraction
    double length;  ///< total variation of the function along the arc
  };
  std::vector<ReebNode> nodes;
  std::vector<Arc> arcs;
  std::vector<uint32_t> arc_of;  ///< per arc of the input, the arc that it became part of, or kNone
  std::vector<uint32_t> node_of;  ///< per arc of the input, the node that it shrank into, or kNone

  uint32_t degree(uint32_t node) const;
};

/// Cancels, shortest first, the arcs shorter than `persistence` (in units of the function): an arc
/// to a minimum or maximum is dropped unless `keep` (per node of `graph`) holds its end, an arc
/// between two saddles is contracted. Nodes of degree two dissolve. The number of independent
/// cycles and of components stays.
SimplifiedGraph simplify(const ReebGraph& graph, const std::vector<bool>& keep, double persistence);

}  // namespace reeb::segmentation
