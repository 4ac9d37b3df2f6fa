// From the arcs of a Reeb graph to regions of the surface.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "segmentation/graph_simplification.h"
#include "segmentation/surface.h"

namespace reeb::segmentation {

struct RegionCut {
  std::vector<uint32_t> labels;  ///< per vertex: arc i has region i, bodies come after the arcs
  uint32_t region_count = 0;     ///< an arc without a vertex of its own has an empty region
  std::vector<uint32_t> node_region;  ///< per node, its body's region or kNone
};

struct RegionCutOptions {
  double
      window;  ///< interval of f, from a saddle into an arc, in which the border is searched; >= 0
  double min_body;  ///< a body smaller than this part of the vertices is left to the arcs around; 0
                    ///< .. 1
};

/// Regions of one surface: first every arc takes its vertices, cut at the critical values. Then,
/// inside the window, the border of an arc that ends at a branching moves to the iso-contour of
/// least concavity function: its length times exp(its mean smaller principal curvature in units of
/// its own radius), so that it falls into a short and deep valley. What lies beyond belongs to the
/// body at the branching: the largest arc there that goes on to another branching or, if all end
/// there, a region of the node itself.
RegionCut cut_regions(const Surface& surface, std::span<const double> f, const ReebGraph& sweep,
                      const SimplifiedGraph& graph, const Eigen::VectorXd& curvature,
                      const RegionCutOptions& options);

}  // namespace reeb::segmentation
