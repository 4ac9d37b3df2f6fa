// Cutting regions into small compact patches.
#pragma once

#include <vector>

#include "segmentation/surface.h"

namespace reeb::segmentation {

/// Cuts each region of one surface into connected patches of about `patch_vertices` vertices: seeds
/// are placed farthest from each other within the region, and each vertex joins the seed nearest
/// along edges. Returns patch indices per vertex, from `first` on, and adds their number to
/// `first`.
std::vector<uint32_t> cut_patches(const Surface& surface, const std::vector<uint32_t>& labels,
                                  uint32_t patch_vertices, uint32_t& first);

}  // namespace reeb::segmentation
