#include "codec/common/fast/surface.h"

#include <mutex>
#include <utility>

#include "codec/common/fast/contraction.h"

namespace reeb {

namespace {

SurfaceGraph graph_of(const ReferenceMesh& mesh, const StopToken& stop) {
  const GridPoints points(mesh.grid);
  if (!mesh.plain) return build_surface_graph(points, mesh.triangles, stop);
  SurfaceGraph out = contract_mesh(mesh.vertex_count, mesh.triangles, stop);
  weigh_rows(points, out);
  return out;
}

}  // namespace

struct Surface::Lanes {
  std::once_flag made;
  LaneStart start;
};

Surface::Surface() : lanes_(std::make_unique<Lanes>()) {}
Surface::Surface(ReferenceMesh& mesh, const StopToken& stop)
    : SurfaceGraph(graph_of(mesh, stop)),
      grid(std::move(mesh.grid)),
      plain(mesh.plain),
      lanes_(std::make_unique<Lanes>()) {}
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;
Surface::~Surface() = default;

const LaneStart& Surface::lanes(const StopToken& stop) const {
  std::call_once(lanes_->made, [&] { lanes_->start = lane_start(*this, points(), stop); });
  return lanes_->start;
}

}  // namespace reeb
