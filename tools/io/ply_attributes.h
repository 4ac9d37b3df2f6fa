// Properties of PLY vertices and faces as attributes, and the other way round.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"
#include "tools/io/mesh_file.h"
#include "tools/io/ply_header.h"

namespace reeb::tools {

/// Reads the properties of an element but for those that are positions or faces. Neighbours that
/// belong together are one attribute, named by all of them: "red green blue", "nx ny nz", "s t".
class PlyAttributes {
 public:
  /// No more than `most` attributes.
  PlyAttributes(const PlyElement& element, Domain domain, size_t most);

  /// Takes the value of property `i` where it is kept.
  template <typename Values>
  bool take(int i, const PlyProperty& property, Values& in) {
    const size_t target = attribute_of_[static_cast<size_t>(i)];
    if (target == kNone) return false;
    if (attributes_[target].type == ValueType::kBinary32)
      add(target, in.real(property.type));
    else
      add(target, in.integer(property.type));
    return true;
  }

  /// Adds the attributes to a frame, and what was not kept or changed.
  void finish(MeshFrame& out);

 private:
  static constexpr size_t kNone = SIZE_MAX;

  void add(size_t target, const Real& x);
  void add(size_t target, int64_t x);
  void append(size_t target, uint32_t bits, size_t size);

  const PlyElement& element_;
  std::vector<size_t> attribute_of_;  ///< of each property
  std::vector<Attribute> attributes_;
  std::vector<uint64_t> changed_;  ///< numbers that are not what the file says, of each attribute
};

/// Columns of an element that attributes become.
struct PlyColumns {
  struct Column {
    std::string name;
    const Attribute* attribute;
    uint32_t channel;
  };
  std::vector<Column> columns;

  /// Adds an attribute's; `written` is the attribute.
  void add(const Attribute& attribute);
  /// Lines of the header.
  std::string header() const;
  /// Numbers of element `index`, little endian.
  void append_row(size_t index, std::string& out) const;
};

/// Corner values as those of vertices, where all corners of every vertex agree; else without
/// values.
Attribute at_vertices(const Attribute& corners, const Connectivity& connectivity);

}  // namespace reeb::tools
