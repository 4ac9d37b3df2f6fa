// What a group has learned, for the next one to continue.
#pragma once

#include <memory>

#include "codec/common/fields/field.h"
#include "codec/common/prediction/prediction_graph.h"

namespace reeb {

/// Empty before the first group and where the last one has nothing to hand on. The weights of the
/// basis are no part of it: what one stretch of time teaches about its basis misleads the next.
struct GroupState {
  std::unique_ptr<Field> coefficients;  ///< refers to the surface graph it was started on
  MagnitudeModel basis_contexts;
};

/// State of a group of the main profile that starts from the reference mesh alone; `weak_prior` as
/// in its header; `components`: the most that come before it is used up.
GroupState start_closed_group(const SurfaceGraph& surface, const GridPoints& points,
                              bool weak_prior, unsigned threads, const StopToken& stop = {},
                              uint32_t components = UINT32_MAX);

}  // namespace reeb
