// Animated sequences made from nothing, for demonstrations and tests.
//
// They use sums, products, quotients and square roots of IEEE-754 binary64 only, and a sine of
// their own, so the same name and length give the same bits on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"

namespace reeb::tools {

struct SampleInfo {
  const char* name;
  const char* description;
};

/// What `make_sample` knows beside figures.
const std::vector<SampleInfo>& samples();

/// "KIND-N: ...": the names of figures (see figures.h), for people.
std::string figure_description();

/// Frames 1 .. `frame_count` (>= 1; 0 = the default) of the sample or figure called `name`, 25
/// frames per second; with what it has beside positions if `attributes`.
Status make_sample(const std::string& name, uint32_t frame_count, Sequence& out,
                   bool attributes = false);

// The samples one by one; frame_count >= 1.

/// A four-legged animal walking along x: one closed connected surface of triangles, over 5,000
/// vertices. A texture's coordinates with seams along its limbs, claws of another material than the
/// skin with edges in their normals.
Sequence make_creature(uint32_t frame_count);

/// A cloth of quadrilaterals hung by its upper edge, in gusts of wind; one boundary. How far its
/// threads are stretched in each frame.
Sequence make_sheet(uint32_t frame_count);

/// Gears, a crank, a rod and a piston: rigid closed components of triangles and quadrilaterals,
/// each a group with a colour.
Sequence make_mechanism(uint32_t frame_count);

}  // namespace reeb::tools
