#include <utility>

#include "codec/dec/field_decoder.h"
#include "codec/dec/group_parts.h"
#include "codec/dec/profile_groups.h"

namespace reeb {

namespace {

Status check_header(const GroupTask& task) {
  if (Status s = check_components(task.header()); !s.ok()) return s;
  if (Status s = check_motion(task.header()); !s.ok()) return s;
  if (Status s = refuse_plain(task); !s.ok()) return s;
  if (task.header().weak_prior() && task.chunk.continues())
    return Status::corrupt("a group has weights of a weak prior, but does not start to learn any");
  return {};
}

/// What the group starts from.
Status start_group(const GroupTask& task, GroupState& state) {
  if (!task.chunk.continues()) {
    const uint32_t components = task.left != nullptr ? UINT32_MAX : task.header().component_count;
    state = start_closed_group(task.surface(), task.surface().points(), task.header().weak_prior(),
                               task.threads, task.stop, components);
    return {};
  }
  state = std::move(task.before);
  if (state.coefficients != nullptr) {
    state.coefficients->set_stop(task.stop);
    return {};
  }
  return Status::corrupt("a group continues one that is not there or of another profile");
}

Status decode_coefficients(const GroupTask& task, GroupState& state, Planes& planes) {
  const uint32_t count = task.header().component_count;
  if (task.left == nullptr && task.chunk.continues()) state.coefficients->expect(count);
  const bool whole = decode_field(task.chunk.coefficients, count, *state.coefficients, task.stop);
  if (Status s = section_status(whole, "coefficient", task.stop); !s.ok()) return s;
  planes =
      task.left != nullptr ? state.coefficients->next_group() : state.coefficients->take_planes();
  return {};
}

Status decode_basis(const GroupTask& task, const PredictionGraph& graph, GroupState& state,
                    Planes& basis) {
  const uint32_t count = task.header().component_count + 1;
  Field field(graph, basis_field_options(), 1);
  std::swap(field.model(), state.basis_contexts);
  field.set_stop(task.stop);
  field.expect(count);
  const bool whole = decode_field(task.chunk.basis, count, field, task.stop);
  std::swap(field.model(), state.basis_contexts);
  basis = field.take_planes();
  return section_status(whole, "basis", task.stop);
}

}  // namespace

Status decode_main_group(const GroupTask& task, GroupSynthesis& out) {
  if (Status s = check_header(task); !s.ok()) return s;
  GroupState state;
  if (Status s = start_group(task, state); !s.ok()) return s;
  Planes planes, basis;
  if (Status s = decode_coefficients(task, state, planes); !s.ok()) return s;
  if (task.left == nullptr) state.coefficients.reset();  // makes room
  if (Status s = decode_motion(task, 0, planes); !s.ok()) return s;
  const TemporalGraph temporal = build_temporal_graph(task.header().frame_count);
  if (Status s = decode_basis(task, temporal.graph, state, basis); !s.ok()) return s;
  out = join_fields(task, std::move(planes), basis, temporal.order);
  if (Status s = decode_corrections(task, out); !s.ok()) return s;
  if (task.left != nullptr) *task.left = std::move(state);
  return {};
}

}  // namespace reeb
