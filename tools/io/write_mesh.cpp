#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "tools/io/attribute_values.h"
#include "tools/io/mesh_file.h"
#include "tools/io/ply_attributes.h"
#include "tools/io/text_writer.h"

namespace reeb::tools {
namespace {

void append_bytes(std::string& out, uint32_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

void append_float(std::string& out, float value) {
  append_bytes(out, std::bit_cast<uint32_t>(value), 4);
}

/// Attributes as formats take them that have no corners.
struct FlatAttributes {
  FlatAttributes(const Connectivity& connectivity, std::span<const Attribute> attributes) {
    from_corners.reserve(attributes.size());
    for (const Attribute& a : attributes) {
      if (a.domain == Domain::kFace) faces.push_back({&a, &a});
      if (a.domain == Domain::kVertex) vertices.push_back({&a, &a});
      if (a.domain != Domain::kCorner || a.name.ends_with(".index")) continue;
      Attribute flat = at_vertices(a, connectivity);
      if (flat.values.empty()) continue;
      from_corners.push_back(std::move(flat));
      vertices.push_back({&from_corners.back(), &a});
    }
  }

  struct Entry {
    const Attribute* values;
    const Attribute* original;
  };
  std::vector<Entry> vertices;
  std::vector<Entry> faces;
  std::vector<Attribute> from_corners;
};

/// Letters and columns of an OFF.
struct OffColumns {
  OffColumns(const FlatAttributes& flat, std::vector<const Attribute*>& written) {
    const auto find = [&](const auto& entries, Semantic semantic, uint32_t least, uint32_t most) {
      for (const auto& entry : entries) {
        const Attribute& a = *entry.values;
        if (a.semantic != semantic || a.channel_count < least || a.channel_count > most) continue;
        written.push_back(entry.original);
        return entry.values;
      }
      return static_cast<const Attribute*>(nullptr);
    };
    normals = find(flat.vertices, Semantic::kNormal, 3, 3);
    colours = find(flat.vertices, Semantic::kColour, 3, 4);
    texture = find(flat.vertices, Semantic::kTextureCoordinate, 2, 2);
    face_colours = find(flat.faces, Semantic::kColour, 3, 4);
  }

  std::string keyword() const {
    return std::string(texture != nullptr ? "ST" : "") + (colours != nullptr ? "C" : "") +
           (normals != nullptr ? "N" : "") + "OFF\n";
  }
  static void append(std::string& out, const Attribute* a, size_t element) {
    for (uint32_t c = 0; a != nullptr && c < a->channel_count; ++c) {
      const size_t i = element * a->channel_count + c;
      out += ' ';
      if (a->type == ValueType::kU8Normalised || a->type == ValueType::kU8)
        append_number(out, uint32_t{a->get<uint8_t>(i)});
      else
        append_number(out, number_of(*a, i));
    }
  }

  const Attribute* normals = nullptr;
  const Attribute* colours = nullptr;
  const Attribute* texture = nullptr;
  const Attribute* face_colours = nullptr;
};

std::string write_off(const Connectivity& connectivity, std::span<const float> positions,
                      std::span<const Attribute> attributes, std::vector<std::string>* unkept) {
  const FlatAttributes flat(connectivity, attributes);
  std::vector<const Attribute*> written;
  const OffColumns columns(flat, written);
  std::string out = columns.keyword();
  append_number(out, connectivity.vertex_count);
  out += ' ';
  append_number(out, connectivity.face_sizes.size());
  out += " 0\n";
  for (size_t v = 0; v < connectivity.vertex_count; ++v) {
    for (size_t axis = 0; axis < 3; ++axis) {
      if (axis > 0) out += ' ';
      append_number(out, positions[3 * v + axis]);
    }
    for (const Attribute* a : {columns.normals, columns.colours, columns.texture})
      OffColumns::append(out, a, v);
    out += '\n';
  }
  size_t number = 0;
  for_each_face(connectivity, [&](std::span<const uint32_t> face) {
    append_number(out, face.size());
    for (const uint32_t v : face) {
      out += ' ';
      append_number(out, v);
    }
    OffColumns::append(out, columns.face_colours, number++);
    out += '\n';
  });
  list_unwritten(attributes, written, unkept);
  return out;
}

std::string write_ply(const Connectivity& connectivity, std::span<const float> positions,
                      std::span<const Attribute> attributes, std::vector<std::string>* unkept) {
  const FlatAttributes flat(connectivity, attributes);
  PlyColumns vertex_columns, face_columns;
  std::vector<const Attribute*> written;
  for (const auto& [entries, columns] :
       {std::pair{&flat.vertices, &vertex_columns}, std::pair{&flat.faces, &face_columns}}) {
    for (const FlatAttributes::Entry& entry : *entries) {
      columns->add(*entry.values);
      written.push_back(entry.original);
      if (unkept != nullptr && !entry.values->names.empty())
        unkept->push_back("names of " + entry.values->name);
    }
  }
  list_unwritten(attributes, written, unkept);
  const auto& sizes = connectivity.face_sizes;
  const bool small = std::all_of(sizes.begin(), sizes.end(), [](uint32_t n) { return n < 256; });
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(connectivity.vertex_count) +
                    "\nproperty float x\nproperty float y\nproperty float z\n" +
                    vertex_columns.header() + "element face " + std::to_string(sizes.size()) +
                    "\nproperty list " + (small ? "uchar" : "uint") + " int vertex_indices\n" +
                    face_columns.header() + "end_header\n";
  for (size_t v = 0; v < connectivity.vertex_count; ++v) {
    for (size_t axis = 0; axis < 3; ++axis) append_float(out, positions[3 * v + axis]);
    vertex_columns.append_row(v, out);
  }
  size_t number = 0;
  for_each_face(connectivity, [&](std::span<const uint32_t> face) {
    append_bytes(out, static_cast<uint32_t>(face.size()), small ? 1 : 4);
    for (const uint32_t v : face) append_bytes(out, v, 4);
    face_columns.append_row(number++, out);
  });
  return out;
}

using Position = std::array<float, 3>;

Position unit_normal(const Position& a, const Position& b, const Position& c) {
  std::array<double, 3> u{};
  std::array<double, 3> w{};
  for (size_t i = 0; i < 3; ++i) {
    u[i] = double{b[i]} - double{a[i]};
    w[i] = double{c[i]} - double{a[i]};
  }
  const std::array<double, 3> n{u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                                u[0] * w[1] - u[1] * w[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0)) return {0, 0, 0};
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

std::string write_stl(const Connectivity& connectivity, std::span<const float> positions) {
  std::string out = "written by reeb";
  out.resize(84);
  uint32_t count = 0;
  const auto point = [&](uint32_t v) {
    return Position{positions[size_t{3} * v], positions[size_t{3} * v + 1],
                    positions[size_t{3} * v + 2]};
  };
  for_each_face(connectivity, [&](std::span<const uint32_t> face) {
    for (size_t i = 2; i < face.size(); ++i, ++count) {
      const std::array<Position, 3> corners{point(face[0]), point(face[i - 1]), point(face[i])};
      for (const float x : unit_normal(corners[0], corners[1], corners[2])) append_float(out, x);
      for (const Position& p : corners) {
        for (const float x : p) append_float(out, x);
      }
      out.append(2, '\0');
    }
  });
  std::string announced;
  append_bytes(announced, count, 4);
  out.replace(80, 4, announced);
  return out;
}

}  // namespace

std::string write_mesh(const Connectivity& connectivity, std::span<const float> positions,
                       MeshFormat format, std::span<const Attribute> attributes,
                       std::vector<std::string>* unkept) {
  switch (format) {
    case MeshFormat::kObj:
      return write_obj(connectivity, positions, attributes, unkept);
    case MeshFormat::kPly:
      return write_ply(connectivity, positions, attributes, unkept);
    case MeshFormat::kOff:
      return write_off(connectivity, positions, attributes, unkept);
    case MeshFormat::kStl:
      list_unwritten(attributes, {}, unkept);
      return write_stl(connectivity, positions);
  }
  return {};
}

}  // namespace reeb::tools
