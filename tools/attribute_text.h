// Attributes in words.
#pragma once

#include <string>

#include "bitstream/attribute_kinds.h"

namespace reeb::tools {

/// "texture coordinate"
std::string to_string(Semantic semantic);
/// "vertex"
std::string to_string(Domain domain);
/// "float32", "uint8", "uint8 normalised"
std::string to_string(ValueType type);

}  // namespace reeb::tools
