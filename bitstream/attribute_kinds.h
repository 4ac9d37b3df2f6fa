// What attributes may be, for those who hold them in memory as for those who code them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace reeb {

inline constexpr uint32_t kMaxAttributes = 256;  ///< of a shot
inline constexpr uint32_t kMaxChannels = 16;
inline constexpr size_t kMaxAttributeName = 256;  ///< bytes; of a resource's name, too
inline constexpr size_t kMaxMediaType = 128;      ///< bytes

/// What values mean.
enum class Semantic : uint8_t {
  kGeneric = 0,
  kTextureCoordinate = 1,
  kNormal = 2,
  kTangent = 3,
  kColour = 4,
  kVelocity = 5,
  kMaterial = 6,  ///< index in the attribute's table of names
  kGroup = 7,     ///< the same
  kIndex = 8,     ///< of corners: place of their value in a list of the source, such as OBJ's vt
};
inline constexpr uint64_t kLastSemantic = 8;

/// What there is one value of.
enum class Domain : uint8_t { kVertex = 0, kCorner = 1, kFace = 2, kShot = 3 };

enum class ValueType : uint8_t {
  kBinary32 = 0,
  kU8 = 1,
  kU16 = 2,
  kI32 = 3,
  kU8Normalised = 4,   ///< n stands for n / 255
  kU16Normalised = 5,  ///< n stands for n / 65535
};
inline constexpr uint64_t kLastValueType = 5;

}  // namespace reeb
