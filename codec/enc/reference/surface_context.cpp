#include "codec/enc/reference/surface_context.h"

#include <algorithm>
#include <cmath>

namespace reeb {

namespace {

/// Nearest grid points; the grid is chosen so that all of them lie on it.
std::vector<int32_t> snap(std::span<const float> xyz, const ReferenceHeader& header) {
  std::vector<int32_t> grid(xyz.size());
  for (size_t i = 0; i < xyz.size(); ++i) {
    const double offset = static_cast<double>(xyz[i]) - static_cast<double>(header.origin[i % 3]);
    const double cell = header.grid_step > 0 ? offset / static_cast<double>(header.grid_step) : 0;
    grid[i] = static_cast<int32_t>(std::clamp(std::round(cell), 0.0, double{kGridMax}));
  }
  return grid;
}

}  // namespace

Bounds bounds_of(std::span<const float> xyz) {
  Bounds out{{xyz[0], xyz[1], xyz[2]}, 0};
  float high[3] = {xyz[0], xyz[1], xyz[2]};
  for (size_t i = 0; i < xyz.size(); ++i) {
    out.low[i % 3] = std::min(out.low[i % 3], xyz[i]);
    high[i % 3] = std::max(high[i % 3], xyz[i]);
  }
  for (int a = 0; a < 3; ++a)
    out.side = std::max(out.side, static_cast<double>(high[a]) - static_cast<double>(out.low[a]));
  return out;
}

Status make_surface_context(const Shot& shot, ReferencePlan& plan, uint32_t bits,
                            const ReferenceOptions& options, SurfaceContext& out) {
  const std::span<const float> first = shot.frame(0);
  const Bounds bounds = bounds_of(first);
  std::copy(std::begin(bounds.low), std::end(bounds.low), out.header.origin);
  out.header.grid_step = static_cast<float>(bounds.side / ((1u << bits) - 1));
  const std::vector<int32_t> grid = snap(first, out.header);
  Status status = encode_reference(plan, grid, options, out.bytes, out.mesh, out.input_of);
  if (!status.ok()) return status;
  out.surface = Surface(out.mesh);
  out.input.resize(out.mesh.vertex_count);
  out.row_of.resize(out.mesh.vertex_count);
  for (uint32_t row = 0; row < out.rows(); ++row) {
    out.input[row] = out.input_of[out.surface.order[row]];
    out.row_of[out.input[row]] = row;
  }
  return {};
}

}  // namespace reeb
