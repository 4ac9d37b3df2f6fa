#include <utility>

#include "codec/common/fast/lane_field.h"
#include "codec/dec/group_parts.h"
#include "codec/dec/profile_groups.h"

namespace reeb {

namespace {

Status decode_coefficients(const GroupTask& task, Planes& planes) {
  LaneField field(task.surface().graph, task.surface().lanes(task.stop), task.header().wary());
  const bool whole = decode_lane_field(task.chunk.coefficients, task.header().component_count,
                                       field, planes, task.stop);
  return section_status(whole, "coefficient", task.stop);
}

Status decode_basis(const GroupTask& task, const PredictionGraph& graph, Planes& basis) {
  const std::vector<float> weights = prior_weights(graph);
  LaneField field(graph, weights);
  const bool whole = decode_lane_field(task.chunk.basis, task.header().component_count + 1, field,
                                       basis, task.stop);
  return section_status(whole, "basis", task.stop);
}

}  // namespace

Status decode_fast_group(const GroupTask& task, GroupSynthesis& out) {
  if (Status s = check_components(task.header()); !s.ok()) return s;
  if (Status s = check_motion(task.header()); !s.ok()) return s;
  if (Status s = refuse_continuing(task.chunk); !s.ok()) return s;
  Planes planes, basis;
  if (Status s = decode_coefficients(task, planes); !s.ok()) return s;
  if (Status s = decode_motion(task, 0, planes); !s.ok()) return s;
  const TemporalGraph temporal = build_temporal_graph(task.header().frame_count);
  if (Status s = decode_basis(task, temporal.graph, basis); !s.ok()) return s;
  out = join_fields(task, std::move(planes), basis, temporal.order);
  return decode_corrections(task, out);
}

}  // namespace reeb
