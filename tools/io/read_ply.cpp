#include <algorithm>
#include <array>

#include "tools/io/mesh_file.h"
#include "tools/io/ply_attributes.h"
#include "tools/io/ply_header.h"
#include "tools/io/ply_values.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

/// As many are named where they are not kept.
constexpr size_t kMaxNamed = 32;

bool is_list(const PlyElement& element, int property) {
  return element.properties[static_cast<size_t>(property)].is_list;
}

/// Reads the elements by `Values`, one of the two of ply_values.h.
template <typename Values>
class PlyReader {
 public:
  PlyReader(const Values& in, const PlyHeader& header, MeshFrame& out)
      : in_(in), header_(header), out_(out) {}

  Status run() {
    for (const PlyElement& element : header_.elements) {
      if (Status status = read_element(element); !status.ok()) return status;
    }
    return in_.finish(out_.notes);
  }

 private:
  Status read_element(const PlyElement& element) {
    const size_t row_bytes = element.min_row_bytes(header_.encoding);
    // The last value of a text needs no separator, hence the one byte more.
    if (row_bytes != 0 && element.count > (in_.remaining() + 1) / row_bytes) {
      return Status::corrupt("the " + element.name + " list has " + grouped(element.count) +
                             " entries, more than fit into the file; it is truncated or damaged, "
                             "export it again");
    }
    if (element.count == 0) return {};
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element);
    if (element.name == "tristrips") {
      return Status::corrupt("triangle strips are not supported; export the file with faces");
    }
    if (element.properties.empty()) return {};
    return read_rows(
        element, [](int, const PlyProperty&) { return false; }, [](uint64_t) { return Status(); });
  }

  Status read_vertices(const PlyElement& element) {
    const std::array<int, 3> axes{element.find("x"), element.find("y"), element.find("z")};
    for (const int axis : axes) {
      if (axis < 0 || is_list(element, axis)) {
        return Status::corrupt("the vertices have no x, y and z; export the file again");
      }
    }
    out_.positions.reserve(element.count * 3);
    std::array<Real, 3> xyz;
    PlyAttributes attributes(element, Domain::kVertex, kMaxAttributes / 2);
    const auto take = [&](int i, const PlyProperty& property) {
      const auto axis = std::find(axes.begin(), axes.end(), i) - axes.begin();
      if (axis == 3) return attributes.take(i, property, in_);
      xyz[static_cast<size_t>(axis)] = in_.real(property.type);
      return true;
    };
    const auto end_row = [&](uint64_t) {
      for (const Real& x : xyz) out_.append_coordinate(x);
      return Status();
    };
    out_.connectivity.vertex_count = static_cast<uint32_t>(element.count);
    Status status = read_rows(element, take, end_row);
    if (status.ok()) attributes.finish(out_);
    return status;
  }

  Status read_faces(const PlyElement& element) {
    const int list = element.find("vertex_indices", "vertex_index");
    if (list < 0 || !is_list(element, list)) {
      return Status::corrupt("the faces have no list vertex_indices; export the file again");
    }
    auto& sizes = out_.connectivity.face_sizes;
    bool good = true;
    PlyAttributes attributes(element, Domain::kFace, kMaxAttributes / 2);
    const auto take = [&](int i, const PlyProperty& property) {
      if (i != list) return attributes.take(i, property, in_);
      good = read_corners(property);
      return true;
    };
    const auto end_row = [&](uint64_t row) {
      if (!good) return row_failure(element, row);
      if (sizes.back() > 0) return Status();
      return Status::corrupt("face " + grouped(row + 1) + " has no vertices; leave it out");
    };
    Status status = read_rows(element, take, end_row);
    if (status.ok()) attributes.finish(out_);
    return status;
  }

  bool read_corners(const PlyProperty& property) {
    const int64_t size = in_.integer(property.count_type);
    if (size < 0 || static_cast<uint64_t>(size) > in_.remaining()) return false;
    for (int64_t i = 0; i < size; ++i) {
      const int64_t vertex = in_.integer(property.type);
      if (vertex < 0 || vertex > UINT32_MAX || in_.failed()) return false;
      out_.connectivity.corners.push_back(static_cast<uint32_t>(vertex));
    }
    out_.connectivity.face_sizes.push_back(static_cast<uint32_t>(size));
    return true;
  }

  /// take(index, property) reads a property's value, or returns false where it is to be skipped;
  /// end_row(row) follows those of a row that makes sense.
  template <typename Take, typename EndRow>
  Status read_rows(const PlyElement& element, const Take& take, const EndRow& end_row) {
    for (uint64_t row = 0; row < element.count; ++row) {
      in_.begin_row();
      int i = 0;
      for (const PlyProperty& property : element.properties) {
        if (!take(i++, property)) skip(property);
      }
      in_.end_row();
      if (in_.failed()) return row_failure(element, row);
      if (Status status = end_row(row); !status.ok()) return status;
    }
    return {};
  }

  void skip(const PlyProperty& property) {
    const int64_t count = property.is_list ? in_.integer(property.count_type) : 1;
    in_.skip(property.type, static_cast<uint64_t>(count));  // a negative one is too many, too
  }

  Status row_failure(const PlyElement& element, uint64_t row) const {
    return Status::corrupt("the " + element.name + " list ends or breaks at entry " +
                           grouped(row + 1) + " of " + grouped(element.count) + ": " +
                           in_.failure().message());
  }

  Values in_;
  const PlyHeader& header_;
  MeshFrame& out_;
};

// Elements but for vertices and faces, whose properties are told when they are read.
std::vector<Unkept> unkept(const PlyHeader& header) {
  std::vector<Unkept> out;
  if (header.textures > 0) out.push_back({"textures", header.textures});
  Unkept others{"further elements", 0};
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex" || element.name == "face" || element.count == 0) continue;
    if (out.size() < kMaxNamed)
      out.push_back({element.name, element.count});
    else
      others.count += element.count;
  }
  if (others.count > 0) out.push_back(others);
  return out;
}

}  // namespace

Status read_ply(std::string_view bytes, MeshFrame& out) {
  std::string_view file;
  if (Status status = skip_mark(bytes, file); !status.ok()) return status;
  PlyHeader header;
  if (Status status = read_ply_header(file, header); !status.ok()) return status;
  out.unkept = unkept(header);
  if (header.encoding == PlyEncoding::kAscii) {
    return PlyReader(PlyTextValues(file, header.bytes), header, out).run();
  }
  const bool big = header.encoding == PlyEncoding::kBigEndian;
  return PlyReader(PlyBinaryValues(file, header.bytes, big), header, out).run();
}

}  // namespace reeb::tools
