#include <array>
#include <bit>
#include <cstring>
#include <unordered_map>

#include "tools/io/mesh_file.h"
#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

constexpr size_t kHeaderBytes = 84;
constexpr size_t kTriangleBytes = 50;

using Point = std::array<float, 3>;

struct PointHash {
  size_t operator()(const Point& p) const {
    uint64_t h = 0;
    for (const float x : p) {
      // Adding zero makes -0 and 0, which compare equal, hash equal.
      h = (h ^ std::bit_cast<uint32_t>(x + 0.0f)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return static_cast<size_t>(h);
  }
};

uint32_t announced_triangles(std::string_view bytes) {
  uint32_t count = 0;
  for (int i = 3; i >= 0; --i) count = count << 8 | static_cast<uint8_t>(bytes[80 + i]);
  return count;
}

float little_endian_float(const char* at) {
  uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | static_cast<uint8_t>(at[i]);
  return std::bit_cast<float>(bits);
}

std::vector<Point> read_binary(std::string_view bytes) {
  const size_t count = announced_triangles(bytes);
  std::vector<Point> corners;
  corners.reserve(count * 3);
  for (size_t i = 0; i < count; ++i) {
    const char* const at =
        bytes.data() + kHeaderBytes + i * kTriangleBytes + 12;  // past the normal
    for (int c = 0; c < 3; ++c) {
      corners.push_back({little_endian_float(at + 12 * c), little_endian_float(at + 12 * c + 4),
                         little_endian_float(at + 12 * c + 8)});
    }
  }
  return corners;
}

Status read_ascii(std::string_view bytes, std::vector<Point>& corners) {
  TextCursor in(bytes);
  bool closed = false;
  size_t loop_size = 0;
  for (; !in.done(); in.next_line()) {
    in.skip_blanks();
    const std::string_view word = in.word();
    if (word == "vertex") {
      Point p{};
      for (float& x : p) {
        in.skip_blanks();
        if (!in.read(x)) return in.error("a vertex needs three numbers; the file is damaged");
      }
      corners.push_back(p);
      ++loop_size;
    } else if (word == "endloop") {
      if (loop_size != 3) return in.error("a facet is not a triangle; the file is damaged");
      loop_size = 0;
    } else if (word == "endsolid") {
      closed = true;
    }
  }
  if (!closed || loop_size != 0) {
    return in.error("endsolid is missing; the file is truncated, export it again");
  }
  return {};
}

// True where every vertex of the reference has one position over all its corners.
bool fits_reference(const std::vector<Point>& corners, const Connectivity& reference,
                    std::vector<float>& positions) {
  if (corners.size() != reference.corners.size()) return false;
  std::vector<bool> seen(reference.vertex_count);
  positions.assign(size_t{3} * reference.vertex_count, 0.0f);
  for (size_t c = 0; c < corners.size(); ++c) {
    const uint32_t v = reference.corners[c];
    float* const at = &positions[size_t{3} * v];
    if (seen[v] && Point{at[0], at[1], at[2]} != corners[c]) return false;
    if (!seen[v]) std::memcpy(at, corners[c].data(), sizeof(Point));
    seen[v] = true;
  }
  return true;
}

void weld(const std::vector<Point>& corners, MeshFrame& out) {
  std::unordered_map<Point, uint32_t, PointHash> vertices;
  out.positions.clear();
  out.connectivity.face_sizes.assign(corners.size() / 3, 3);
  for (const Point& p : corners) {
    const auto [entry, added] = vertices.try_emplace(p, static_cast<uint32_t>(vertices.size()));
    if (added) out.positions.insert(out.positions.end(), p.begin(), p.end());
    out.connectivity.corners.push_back(entry->second);
  }
  out.connectivity.vertex_count = static_cast<uint32_t>(vertices.size());
}

}  // namespace

Status read_stl(std::string_view bytes, const MeshReference* reference, MeshFrame& out) {
  std::vector<Point> corners;
  // Binary files may begin with "solid" too, so the size decides.
  const bool has_header = bytes.size() >= kHeaderBytes;
  const size_t need =
      has_header ? kHeaderBytes + kTriangleBytes * size_t{announced_triangles(bytes)} : 0;
  if (has_header && bytes.size() == need) {
    corners = read_binary(bytes);
  } else if (bytes.starts_with("solid")) {
    if (Status status = read_ascii(bytes, corners); !status.ok()) return status;
  } else {
    return Status::corrupt(
        "neither an ascii STL nor a binary one of the size it announces; the file is truncated or "
        "something else, export it again");
  }
  out.same_connectivity =
      reference != nullptr && fits_reference(corners, reference->connectivity, out.positions);
  if (!out.same_connectivity) weld(corners, out);
  return {};
}

}  // namespace reeb::tools
