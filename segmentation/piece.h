// Segmentation of one connected surface.
#pragma once

#include <vector>

#include "segmentation/eigenpairs.h"
#include "segmentation/graph_simplification.h"
#include "segmentation/segmentation.h"
#include "segmentation/surface.h"

namespace reeb::segmentation {

/// Regions of one connected surface; all indices are local to it.
struct PieceResult {
  std::vector<uint32_t> labels;  ///< per vertex, 0 .. region_count-1
  uint32_t region_count = 1;     ///< arcs of the graph; one without a vertex of its own is possible
  std::vector<double> scalar;    ///< f per vertex
  std::vector<uint32_t> features;  ///< vertices, ascending
  SimplifiedGraph graph;
  std::vector<uint32_t> node_region;  ///< per node, the region of its body or kNone
};

/// The whole surface as one arc between two points far apart, without a function.
PieceResult single_region(const Surface& surface);

/// Feature points, scalar function, Reeb graph and regions. False when no function can be computed
/// (no area, no spectrum). `options` are in range. May throw std::exception on numerical trouble in
/// the eigensolver.
bool analyse(const Surface& surface, const Options& options, PieceResult& result);

/// The same with a spectrum at hand; `options.eigenpairs` has no say.
bool analyse(const Surface& surface, const Laplacian& laplacian, const Eigenpairs& pairs,
             const Options& options, PieceResult& result);

}  // namespace reeb::segmentation
