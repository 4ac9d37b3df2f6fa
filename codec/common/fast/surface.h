// What the fields of a shot are predicted on: its reference mesh as a graph of rows.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "codec/common/base/stop.h"
#include "codec/common/fast/lane_weights.h"
#include "codec/common/prediction/prediction_graph.h"
#include "codec/common/reference/reference_mesh.h"

namespace reeb {

/// The same for every reference mesh, however it was coded. May be moved, and used by several
/// threads.
struct Surface : SurfaceGraph {
  Surface();
  /// Takes the grid out of `mesh`. Throws Stopped where `stop` is requested.
  explicit Surface(ReferenceMesh& mesh, const StopToken& stop = {});
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;
  ~Surface();

  std::vector<int32_t> grid;  ///< [coding vertex][xyz]
  bool plain = false;         ///< the mesh is; only the fast profile has groups on such

  uint32_t rows() const { return graph.size(); }
  GridPoints points() const { return GridPoints(grid); }
  /// What fields of the fast profile start from; made when first asked for.
  /// Throws Stopped where `stop` is requested.
  const LaneStart& lanes(const StopToken& stop = {}) const;

 private:
  struct Lanes;
  std::unique_ptr<Lanes> lanes_;
};

}  // namespace reeb
