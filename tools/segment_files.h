// Files that show a segmentation to other programs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"
#include "segmentation/skeleton.h"

namespace reeb::tools {

/// Binary PLY of the mesh with a colour (region_colour) and the region of every vertex.
std::string coloured_ply(const Connectivity& connectivity, std::span<const float> positions,
                         std::span<const uint32_t> labels);

/// OBJ of the skeleton: a vertex per node and point of an arc, a polyline per arc.
std::string graph_obj(const segmentation::Graph& graph, const segmentation::SkeletonPose& pose);

/// JSON of the graph: nodes, arcs and regions with their attributes, and their positions in every
/// pose (one per frame). Vertices, nodes and regions count from 0.
std::string graph_json(const segmentation::Result& segmentation,
                       const std::vector<segmentation::SkeletonPose>& poses);

}  // namespace reeb::tools
