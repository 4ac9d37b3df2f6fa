// The header of a PLY file: what follows it, in which order and in which types.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bitstream/status.h"

namespace reeb::tools {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };
enum class PlyType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble,
  kUnknown,  ///< of any other name: can be skipped in text
};

/// Bytes of one value in a binary file; 0 of an unknown type.
size_t ply_size(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat;
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< of the length before a list
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;  ///< as announced; not checked against the size of the file
  std::vector<PlyProperty> properties;

  /// Index of the property with one of the two names; -1 where there is none.
  int find(std::string_view name_a, std::string_view name_b = {}) const;
  /// The fewest bytes one row takes.
  size_t min_row_bytes(PlyEncoding encoding) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;  ///< no two are "vertex" or "face"
  uint64_t textures = 0;             ///< comments that name one
  size_t bytes = 0;                  ///< length of the header; the data follow
};

/// `file` has no byte-order mark. Types of binary files are known, and names that mean positions or
/// faces occur once.
Status read_ply_header(std::string_view file, PlyHeader& out);

}  // namespace reeb::tools
