// Attributes as colours of a mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"
#include "tools/picture/image.h"

namespace reeb::tools {

/// Numbers that the ends of the scale stand for.
struct ColourScale {
  double low = 0, high = 0;
  bool used = false;  ///< false: colours, directions and whole numbers need none
};

/// The scale that an attribute has in all frames of a sequence. Fails where no shot has it.
Status find_scale(const Sequence& sequence, const std::string& attribute, ColourScale& out);

/// A colour for each corner in frame t of the shot; empty where it lacks the attribute. Colours are
/// shown as they are, directions as (1 + x) / 2, whole numbers each in a colour of its own, other
/// numbers (of several, their length) from blue to red.
std::vector<Colour> paint_corners(const Shot& shot, uint32_t t, const std::string& attribute,
                                  const ColourScale& scale);

/// The two texture coordinates of each corner; empty where there are none.
std::vector<float> texture_coordinates(const Shot& shot, uint32_t t);

}  // namespace reeb::tools
