// What a mesh carries beside positions, in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "bitstream/attribute_kinds.h"

namespace reeb {

constexpr size_t size_of(ValueType type) {
  switch (type) {
    case ValueType::kU8:
    case ValueType::kU8Normalised:
      return 1;
    case ValueType::kU16:
    case ValueType::kU16Normalised:
      return 2;
    case ValueType::kBinary32:
    case ValueType::kI32:
      break;
  }
  return 4;
}

/// One attribute of a shot.
struct Attribute {
  std::string name;  ///< UTF-8, as the source says
  Semantic semantic = Semantic::kGeneric;
  Domain domain = Domain::kVertex;
  ValueType type = ValueType::kBinary32;
  uint32_t channel_count = 1;
  bool animated = false;           ///< values for every frame of the shot; else once
  std::vector<std::string> names;  ///< that material and group indices stand for
  /// Largest error of each channel, > 0, in the values' own unit (of normalised ones, 1 is their
  /// largest number); empty = exact. Asked of an encoder; of no meaning in what is decoded.
  std::vector<double> max_error;
  /// Degrees, 0 = never: normals (three channels of binary32 at vertices or corners) are computed
  /// from decoded positions where they are not further off; a static attribute's in the first
  /// frame. Then they are animated in what is decoded. Asked of an encoder, too.
  double max_angle = 0;
  /// Degrees, 0 = none: what those further off are turned to is at most so far off. Where there are
  /// any, and this is 0 or cannot be done, the attribute is coded as any other.
  double corrected_angle = 0.5;
  /// [frame][element][channel], numbers of `type` as the machine keeps them. Elements are the
  /// vertices, the corners, or the faces of the shot's connectivity, in its order, or the shot.
  std::vector<uint8_t> values;

  size_t element_bytes() const { return channel_count * size_of(type); }

  /// Number i of all, `T` being what `type` says.
  template <class T>
  T get(size_t i) const {
    T out;
    std::memcpy(&out, values.data() + i * sizeof(T), sizeof(T));
    return out;
  }
  template <class T>
  void assign(std::span<const T> numbers) {
    values.resize(numbers.size_bytes());
    if (!numbers.empty()) std::memcpy(values.data(), numbers.data(), numbers.size_bytes());
  }

  bool operator==(const Attribute&) const = default;
};

/// A file that travels along: material text, a texture.
struct Resource {
  std::string name;
  std::string media_type;
  std::vector<uint8_t> bytes;
  bool operator==(const Resource&) const = default;
};

}  // namespace reeb
