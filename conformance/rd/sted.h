// Spatio-temporal edge difference: how much a distortion of an animated mesh shows.
//
// L. Vasa, V. Skala, "A perception correlated comparison method for dynamic meshes", IEEE
// Transactions on Visualization and Computer Graphics 17(2), 2011. What counts is how unevenly the
// lengths of edges change around a vertex; moving or stretching everything alike costs nothing.
//
// Neighbourhood, window and constants are parameters of the measure. Here they are the nearest
// neighbours in space and time and the constants of StedOptions, which could not be checked against
// those that the paper found by people's judgement: compare these figures with each other, not with
// published ones.
#pragma once

#include <span>

#include "codec/common/base/sequence.h"

namespace reeb::conformance {

struct StedOptions {
  double frame_distance = 0.002;   ///< between frames, in diagonals of the sequence's bounding box
  double temporal_weight = 0.136;  ///< of the temporal part
};

struct Sted {
  double spatial = 0;
  double temporal = 0;
  double combined = 0;  ///< sqrt(spatial^2 + (temporal_weight * temporal)^2)
};

/// Compares `decoded` (same layout as `original.positions`) with `original`, whose bounding box
/// over all frames has the given diagonal.
///
/// Spatial part: the relative difference of an edge is | |e| - |e'| | / |e|; at every vertex and
/// frame, its standard deviation over the edges that meet there, weighted by |e|; mean over
/// vertices and frames. Temporal part: the same with the edges that join a vertex to itself one
/// frame on, of length sqrt(frame_distance^2 + |displacement|^2), over the (up to three) such edges
/// from one before to one after. There, positions are scaled by the diagonal. Edges of no length do
/// not count.
Sted spatio_temporal_edge_difference(const Shot& original, std::span<const float> decoded,
                                     double diagonal, const StedOptions& options = {});

}  // namespace reeb::conformance
