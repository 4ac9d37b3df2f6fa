// Reeb graph of a function on the vertices of a surface.
#pragma once

#include <span>

#include "segmentation/segmentation.h"
#include "segmentation/surface.h"

namespace reeb::segmentation {

struct ReebNode {
  uint32_t vertex;
  double value;
  NodeType type;
};

struct ReebArc {
  uint32_t low, high;  ///< nodes, in the order of the sweep
};

struct ReebGraph {
  std::vector<ReebNode> nodes;  ///< in the order of the sweep
  std::vector<ReebArc> arcs;
  std::vector<uint32_t>
      vertex_arc;  ///< per vertex, the arc whose contours pass it; at a critical point the
                   ///< first arc that starts there, or else one that ends there
};

/// Sweeps the level sets of `f` (one value per vertex, linear inside the triangles, equal values
/// ordered by index) upwards and tracks their connected components. Nodes are the critical points
/// at which components appear, vanish, join or split. Any triangle mesh will do; on a closed
/// orientable manifold the graph has as many independent cycles as the surface has handles.
ReebGraph sweep_reeb_graph(const Surface& surface, std::span<const double> f);

}  // namespace reeb::segmentation
