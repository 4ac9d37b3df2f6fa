// What every encoder of a sequence says of it: in the file's headers, and to its caller.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/headers.h"
#include "codec/common/base/sequence.h"
#include "codec/enc/encoder.h"

namespace reeb {

SequenceHeader header_of(const Sequence& sequence);
std::vector<MetadataEntry> metadata_of(const Sequence& sequence);

/// Sum over the shots of vertices times frames.
double vertex_frames_of(const Sequence& sequence);

/// Sum of squares of all coordinates about the mean of each frame and axis.
double energy_of(const Sequence& sequence);
/// In percent; 0 where there is no energy.
double kg_error(double squared_error, double energy);

/// Size, rate and sections of a finished file; no errors.
EncodeStats size_stats(const std::vector<uint8_t>& bytes, double vertex_frames);

}  // namespace reeb
