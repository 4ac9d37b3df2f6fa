// From the attributes of frames, one after another, to those of a shot.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

/// Empty where a further frame of a shot may have the attributes `frame`; what differs otherwise.
std::string attribute_difference(const std::vector<Attribute>& shot,
                                 const std::vector<Attribute>& frame);

/// Appends a frame's values. What never changes is static; names get one table. `frame_count`:
/// frames in the shot before, which has no attributes where that is 0.
void append_attributes(std::vector<Attribute> frame, uint32_t frame_count,
                       std::vector<Attribute>& shot);

/// Frame t of the shot's attributes, each as a static one. `frame_count`: of the shot.
std::vector<Attribute> attributes_of_frame(const std::vector<Attribute>& shot, uint32_t frame_count,
                                           uint32_t t);

}  // namespace reeb::tools
