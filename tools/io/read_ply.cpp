#include <array>
#include <bit>
#include <cmath>

#include "tools/io/mesh_file.h"
#include "tools/io/ply_header.h"
#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

/// Values one after another, in text. After a failure every further read gives zero.
class AsciiValues {
 public:
  explicit AsciiValues(std::string_view bytes) : in_(bytes) {}
  bool failed() const { return failed_; }
  size_t remaining() const { return in_.remaining(); }

  float real(PlyType) { return number<float>(); }
  int64_t integer(PlyType) { return number<int64_t>(); }
  void skip(PlyType, uint64_t count) {
    for (uint64_t i = 0; i < count && !failed_; ++i) {
      in_.skip_space();
      failed_ = in_.word().empty();
    }
  }

 private:
  template <typename T>
  T number() {
    in_.skip_space();
    T value = 0;
    failed_ = failed_ || !in_.read(value);
    return value;
  }

  TextCursor in_;
  bool failed_ = false;
};

/// Values one after another, in binary.
class BinaryValues {
 public:
  BinaryValues(std::string_view bytes, bool big_endian) : in_(bytes), big_endian_(big_endian) {}
  bool failed() const { return failed_; }
  size_t remaining() const { return in_.size(); }

  float real(PlyType type) {
    if (type == PlyType::kFloat) return std::bit_cast<float>(static_cast<uint32_t>(raw(4)));
    if (type == PlyType::kDouble) return static_cast<float>(std::bit_cast<double>(raw(8)));
    return static_cast<float>(integer(type));
  }

  int64_t integer(PlyType type) {
    const size_t size = ply_size(type);
    const uint64_t bits = raw(size);
    switch (type) {
      case PlyType::kInt8:
        return static_cast<int8_t>(bits);
      case PlyType::kInt16:
        return static_cast<int16_t>(bits);
      case PlyType::kInt32:
        return static_cast<int32_t>(bits);
      case PlyType::kFloat:
        return whole(std::bit_cast<float>(static_cast<uint32_t>(bits)));
      case PlyType::kDouble:
        return whole(std::bit_cast<double>(bits));
      default:
        return static_cast<int64_t>(bits);
    }
  }

  void skip(PlyType type, uint64_t count) {
    failed_ = failed_ || count > in_.size() / ply_size(type);
    if (!failed_) in_.remove_prefix(count * ply_size(type));
  }

 private:
  static int64_t whole(double value) {
    return std::abs(value) < 4294967296.0 ? static_cast<int64_t>(value) : -1;
  }

  uint64_t raw(size_t size) {
    if (failed_ || in_.size() < size) {
      failed_ = true;
      return 0;
    }
    uint64_t bits = 0;
    for (size_t i = 0; i < size; ++i) {
      const size_t byte = big_endian_ ? size - 1 - i : i;
      bits |= uint64_t{static_cast<uint8_t>(in_[byte])} << (8 * i);
    }
    in_.remove_prefix(size);
    return bits;
  }

  std::string_view in_;
  bool big_endian_;
  bool failed_ = false;
};

Status truncated(const PlyElement& element, uint64_t row) {
  return Status::corrupt("the " + element.name + " list ends or breaks at entry " +
                         std::to_string(row + 1) + " of " + std::to_string(element.count) +
                         "; the file is truncated or damaged, export it again");
}

template <typename Values>
void skip_property(Values& in, const PlyProperty& property) {
  uint64_t count = 1;
  if (property.is_list) {
    const int64_t size = in.integer(property.count_type);
    count = size > 0 ? static_cast<uint64_t>(size) : 0;
  }
  in.skip(property.type, count);
}

template <typename Values>
Status skip_element(Values& in, const PlyElement& element) {
  for (uint64_t row = 0; row < element.count && !element.properties.empty(); ++row) {
    for (const PlyProperty& property : element.properties) skip_property(in, property);
    if (in.failed()) return truncated(element, row);
  }
  return {};
}

template <typename Values>
Status read_vertices(Values& in, const PlyElement& element, MeshFrame& out) {
  const std::array<int, 3> axes{element.find("x"), element.find("y"), element.find("z")};
  for (const int axis : axes) {
    if (axis < 0 || element.properties[static_cast<size_t>(axis)].is_list) {
      return Status::corrupt("the vertices have no x, y and z; export the file again");
    }
  }
  out.positions.resize(element.count * 3);
  for (uint64_t row = 0; row < element.count; ++row) {
    float* const xyz = &out.positions[row * 3];
    for (int i = 0; i < static_cast<int>(element.properties.size()); ++i) {
      const PlyProperty& property = element.properties[static_cast<size_t>(i)];
      if (i == axes[0]) {
        xyz[0] = in.real(property.type);
      } else if (i == axes[1]) {
        xyz[1] = in.real(property.type);
      } else if (i == axes[2]) {
        xyz[2] = in.real(property.type);
      } else {
        skip_property(in, property);
      }
    }
    if (in.failed()) return truncated(element, row);
  }
  out.connectivity.vertex_count = static_cast<uint32_t>(element.count);
  return {};
}

template <typename Values>
bool read_corners(Values& in, const PlyProperty& property, Connectivity& out) {
  const int64_t size = in.integer(property.count_type);
  if (size < 1 || static_cast<uint64_t>(size) > in.remaining()) return false;
  for (int64_t i = 0; i < size; ++i) {
    const int64_t vertex = in.integer(property.type);
    if (vertex < 0 || vertex > UINT32_MAX) return false;
    out.corners.push_back(static_cast<uint32_t>(vertex));
  }
  out.face_sizes.push_back(static_cast<uint32_t>(size));
  return true;
}

template <typename Values>
Status read_faces(Values& in, const PlyElement& element, MeshFrame& out) {
  const int corners = element.find("vertex_indices", "vertex_index");
  if (corners < 0 || !element.properties[static_cast<size_t>(corners)].is_list) {
    return Status::corrupt("the faces have no list vertex_indices; export the file again");
  }
  for (uint64_t row = 0; row < element.count; ++row) {
    bool good = true;
    for (int i = 0; i < static_cast<int>(element.properties.size()); ++i) {
      const PlyProperty& property = element.properties[static_cast<size_t>(i)];
      if (i == corners) {
        good = read_corners(in, property, out.connectivity);
      } else {
        skip_property(in, property);
      }
    }
    if (!good || in.failed()) return truncated(element, row);
  }
  return {};
}

template <typename Values>
Status read_elements(Values in, const PlyHeader& header, MeshFrame& out) {
  for (const PlyElement& element : header.elements) {
    const size_t row_bytes = element.min_row_bytes(header.encoding);
    // The last value of a text needs no separator, hence the one byte more.
    if (row_bytes != 0 && element.count > (in.remaining() + 1) / row_bytes) {
      return truncated(element, (in.remaining() + 1) / row_bytes);
    }
    Status status;
    if (element.name == "vertex") {
      status = read_vertices(in, element, out);
    } else if (element.name == "face") {
      status = read_faces(in, element, out);
    } else if (element.name == "tristrips") {
      status = Status::corrupt("triangle strips are not supported; export the file with faces");
    } else {
      status = skip_element(in, element);
    }
    if (!status.ok()) return status;
  }
  return {};
}

// Names of the properties that a Sequence has no place for.
std::string extra_properties(const PlyHeader& header) {
  std::string names;
  for (const PlyElement& element : header.elements) {
    for (const PlyProperty& p : element.properties) {
      const bool kept = p.name == "x" || p.name == "y" || p.name == "z" ||
                        p.name == "vertex_indices" || p.name == "vertex_index";
      if (!kept) names += (names.empty() ? "" : ", ") + p.name;
    }
  }
  return names;
}

}  // namespace

Status read_ply(std::string_view bytes, MeshFrame& out) {
  PlyHeader header;
  if (Status status = read_ply_header(bytes, header); !status.ok()) return status;
  out.dropped = extra_properties(header);
  const std::string_view data = bytes.substr(header.bytes);
  if (header.encoding == PlyEncoding::kAscii) return read_elements(AsciiValues(data), header, out);
  return read_elements(BinaryValues(data, header.encoding == PlyEncoding::kBigEndian), header, out);
}

}  // namespace reeb::tools
