#include "codec/common/fields/group_state.h"

namespace reeb {

GroupState start_closed_group(const SurfaceGraph& surface, const GridPoints& points,
                              bool weak_prior, unsigned threads, const StopToken& stop,
                              uint32_t components) {
  GroupState state;
  state.coefficients =
      std::make_unique<Field>(surface.graph, surface_field_options(weak_prior), threads);
  state.coefficients->set_stop(stop);
  state.coefficients->expect(components);
  state.coefficients->learn_reference(points, surface.order);
  return state;
}

}  // namespace reeb
