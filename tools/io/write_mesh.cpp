#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>

#include "tools/io/mesh_file.h"

namespace reeb::tools {
namespace {

template <typename Number>
void append_number(std::string& out, Number value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  out.append(buffer.data(), end);
}

void append_bytes(std::string& out, uint32_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

void append_float(std::string& out, float value) {
  append_bytes(out, std::bit_cast<uint32_t>(value), 4);
}

/// Calls row(corners of the face) for every face.
template <typename Row>
void for_each_face(const Connectivity& connectivity, const Row& row) {
  const uint32_t* corner = connectivity.corners.data();
  for (const uint32_t size : connectivity.face_sizes) {
    row(std::span<const uint32_t>(corner, size));
    corner += size;
  }
}

void append_vertices(std::string& out, std::span<const float> positions, std::string_view prefix) {
  for (size_t i = 0; i < positions.size(); i += 3) {
    out += prefix;
    for (size_t axis = 0; axis < 3; ++axis) {
      append_number(out, positions[i + axis]);
      out += axis == 2 ? '\n' : ' ';
    }
  }
}

std::string write_obj(const Connectivity& connectivity, std::span<const float> positions) {
  std::string out;
  append_vertices(out, positions, "v ");
  for_each_face(connectivity, [&](std::span<const uint32_t> face) {
    out += 'f';
    for (const uint32_t v : face) {
      out += ' ';
      append_number(out, uint64_t{v} + 1);
    }
    out += '\n';
  });
  return out;
}

std::string write_off(const Connectivity& connectivity, std::span<const float> positions) {
  std::string out = "OFF\n";
  append_number(out, connectivity.vertex_count);
  out += ' ';
  append_number(out, connectivity.face_sizes.size());
  out += " 0\n";
  append_vertices(out, positions, "");
  for_each_face(connectivity, [&](std::span<const uint32_t> face) {
    append_number(out, face.size());
    for (const uint32_t v : face) {
      out += ' ';
      append_number(out, v);
    }
    out += '\n';
  });
  return out;
}

std::string write_ply(const Connectivity& connectivity, std::span<const float> positions) {
  const auto& sizes = connectivity.face_sizes;
  const bool small = std::all_of(sizes.begin(), sizes.end(), [](uint32_t n) { return n < 256; });
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(connectivity.vertex_count) +
                    "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                    std::to_string(sizes.size()) + "\nproperty list " + (small ? "uchar" : "uint") +
                    " int vertex_indices\nend_header\n";
  for (const float x : positions) append_float(out, x);
  for_each_face(connectivity, [&](std::span<const uint32_t> face) {
    append_bytes(out, static_cast<uint32_t>(face.size()), small ? 1 : 4);
    for (const uint32_t v : face) append_bytes(out, v, 4);
  });
  return out;
}

using Point = std::array<float, 3>;

Point unit_normal(const Point& a, const Point& b, const Point& c) {
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
    return Point{positions[size_t{3} * v], positions[size_t{3} * v + 1],
                 positions[size_t{3} * v + 2]};
  };
  for_each_face(connectivity, [&](std::span<const uint32_t> face) {
    for (size_t i = 2; i < face.size(); ++i, ++count) {
      const std::array<Point, 3> corners{point(face[0]), point(face[i - 1]), point(face[i])};
      for (const float x : unit_normal(corners[0], corners[1], corners[2])) append_float(out, x);
      for (const Point& p : corners) {
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
                       MeshFormat format) {
  switch (format) {
    case MeshFormat::kObj:
      return write_obj(connectivity, positions);
    case MeshFormat::kPly:
      return write_ply(connectivity, positions);
    case MeshFormat::kOff:
      return write_off(connectivity, positions);
    case MeshFormat::kStl:
      return write_stl(connectivity, positions);
  }
  return {};
}

}  // namespace reeb::tools
