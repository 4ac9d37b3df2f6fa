#include "tools/attribute_text.h"

namespace reeb::tools {

std::string to_string(Semantic semantic) {
  switch (semantic) {
    case Semantic::kGeneric:
      break;
    case Semantic::kTextureCoordinate:
      return "texture coordinate";
    case Semantic::kNormal:
      return "normal";
    case Semantic::kTangent:
      return "tangent";
    case Semantic::kColour:
      return "colour";
    case Semantic::kVelocity:
      return "velocity";
    case Semantic::kMaterial:
      return "material";
    case Semantic::kGroup:
      return "group";
    case Semantic::kIndex:
      return "index";
  }
  return "generic";
}

std::string to_string(Domain domain) {
  switch (domain) {
    case Domain::kVertex:
      break;
    case Domain::kCorner:
      return "corner";
    case Domain::kFace:
      return "face";
    case Domain::kShot:
      return "shot";
  }
  return "vertex";
}

std::string to_string(ValueType type) {
  switch (type) {
    case ValueType::kBinary32:
      break;
    case ValueType::kU8:
      return "uint8";
    case ValueType::kU16:
      return "uint16";
    case ValueType::kI32:
      return "int32";
    case ValueType::kU8Normalised:
      return "uint8 normalised";
    case ValueType::kU16Normalised:
      return "uint16 normalised";
  }
  return "float32";
}

}  // namespace reeb::tools
