// Operations on labelled vertices of one surface: kNone marks a vertex without a region.
#pragma once

#include <span>
#include <vector>

#include "segmentation/segmentation.h"
#include "segmentation/surface.h"

namespace reeb::segmentation {

/// Grows the labelled regions along edges, one ring at a time, over the vertices without one. On a
/// connected surface with at least one label every vertex gets one.
void grow_regions(const Surface& surface, std::vector<uint32_t>& labels);

/// Leaves each region its connected part of the most vertices; the rest goes to the regions around.
void keep_connected(const Surface& surface, std::vector<uint32_t>& labels, uint32_t region_count);

/// Renumbers labels to 0 .. n-1 in order of the first vertex and returns n.
uint32_t renumber(std::vector<uint32_t>& labels);

/// Area of each region: a third of a triangle for each corner, added to `areas`.
void add_region_areas(const Surface& surface, const std::vector<uint32_t>& labels,
                      std::vector<double>& areas);

/// Regions that touch, with the length of the border that runs through the middles of the edges
/// between them.
std::vector<RegionLink> border_links(const Surface& surface, const std::vector<uint32_t>& labels);

/// Links that connect all regions when added to `links`: a shortest tree between the centroids of
/// regions that no chain of links joins. `labels` are those of the vertices of a whole mesh, all of
/// them with a region.
std::vector<RegionLink> gap_links(std::span<const float> positions,
                                  const std::vector<uint32_t>& labels,
                                  const std::vector<RegionLink>& links);

/// Gives each vertex of a whole mesh without a region the label (and `values`) of the nearest
/// vertex that has one, there being at least one; returns how many.
uint32_t label_by_nearest(std::span<const float> positions, std::vector<uint32_t>& labels,
                          std::vector<double>& values);

}  // namespace reeb::segmentation
