// Reeb charts: the parts of a surface that the arcs and bodies of its Reeb graph take, each brought
// to the topology of a disc or an annulus.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "retrieval/patch.h"

namespace reeb::retrieval {

struct Charts {
  std::vector<Patch> patches;  ///< each a disc or an annulus
  std::vector<std::vector<uint32_t>>
      neighbours;  ///< per chart, the charts that it shares an edge of the surface with, ascending
};

struct ChartOptions {
  double hole_area = 0.02;    ///< a boundary is a hole to close if a circle of its length has less
                              ///< than this part of the chart's area; 0 .. 1
  double least_area = 0.002;  ///< smaller parts of the surface's area are no charts; 0 .. 1
};

/// Charts of one surface whose vertices have the regions `labels`. Small holes are closed, of more
/// than two boundaries all but the two longest are capped, handles are cut open, and what has no
/// boundary at all is halved.
Charts cut_charts(const Surface& surface, std::span<const uint32_t> labels,
                  const ChartOptions& options = {});

}  // namespace reeb::retrieval
