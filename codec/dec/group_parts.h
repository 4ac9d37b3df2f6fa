// Parts of groups that several profiles have.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/dec/profile_groups.h"

namespace reeb {

using Planes = std::vector<std::vector<float>>;

/// component_count within 3 * frame_count.
Status check_components(const GroupHeader& header);
/// region_count in range, and no motion section where there are no regions.
Status check_motion(const GroupHeader& header);
/// Of profiles that no group continues another in.
Status refuse_continuing(const GroupChunk& chunk);
/// Of profiles that have no groups on plain meshes.
Status refuse_plain(const GroupTask& task);

/// What came of decoding the section of this name.
Status section_status(bool whole, const char* section, const StopToken& stop);

/// Adds what the motion section predicts to the planes; `stride` as in MotionModel::code.
Status decode_motion(const GroupTask& task, uint32_t stride, Planes& planes);

/// Joins coefficients and basis, whose row r is time * 3 + axis `order[r]`.
GroupSynthesis join_fields(const GroupTask& task, Planes planes, const Planes& basis,
                           const std::vector<uint32_t>& order);

/// The last part of a group: corrections, and whether its positions are defined.
Status decode_corrections(const GroupTask& task, GroupSynthesis& out);

}  // namespace reeb
