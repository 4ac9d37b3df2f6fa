// Who predicts whom: for each row of a field, the earlier rows that its value is predicted from.
//
// A field is anything the codec codes row by row for one component after another: temporal
// coefficients on the vertices of the reference mesh (surface graph), or the temporal basis on its
// times and axes (temporal graph).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/base/item_lists.h"
#include "codec/common/base/raw_vector.h"
#include "codec/common/base/stop.h"
#include "codec/common/mesh/grid.h"

namespace reeb {

inline constexpr uint32_t kMaxNeighbours = 16;

/// Rows are numbered in coding order. All indices of row r are < r, except padding, which is r
/// itself.
struct PredictionGraph {
  struct Row {
    std::array<uint32_t, kMaxNeighbours> neighbour;
    std::array<float, kMaxNeighbours>
        prior;  ///< weights expected before anything is learned; 0 for padding
    std::array<float, kMaxNeighbours>
        precision;      ///< of that expectation, relative to the field's; higher when farther
    uint8_t count = 0;  ///< neighbours in use
    uint8_t ring = 0;   ///< the first of them, next to the row; they make the contexts
  };
  RawVector<Row> rows;
  std::vector<uint8_t>
      step_index;  ///< index into kStepTable: a row that predicts many gets a finer step

  uint32_t size() const { return static_cast<uint32_t>(rows.size()); }
};

/// Step of a row relative to the group's step q, in 1/65536: 65536 * 2^(-0.225 i / 8), i the row's
/// step index, 8 log2 of its prediction mass.
inline constexpr uint32_t kStepSizes = 192;
extern const std::array<uint32_t, kStepSizes> kStepTable;

/// Rows that each row is a neighbour of, each times 2, plus 1 where that is in its ring.
using RowUses = ItemLists<uint32_t>;
RowUses find_uses(const PredictionGraph& graph);

struct SurfaceGraph {
  PredictionGraph graph;
  std::vector<uint32_t> order;  ///< row -> vertex of the reference mesh
};

/// Fills in what the distances between neighbours tell: priors, precisions, steps.
void weigh_rows(const GridPoints& points, SurfaceGraph& surface);

/// Coarse-to-fine graph of the reference mesh. Vertices without triangles come last, by nearness in
/// space.
SurfaceGraph build_surface_graph(const GridPoints& points, std::span<const uint32_t> triangles,
                                 const StopToken& stop = {});

/// Dyadic hierarchy of `frames` times with three axes each: row r of the graph is (time, axis).
struct TemporalGraph {
  PredictionGraph graph;
  std::vector<uint32_t> order;  ///< row -> time * 3 + axis
};
TemporalGraph build_temporal_graph(uint32_t frames);

}  // namespace reeb
