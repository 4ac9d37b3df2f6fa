#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <tuple>

#include "tools/io/mesh_file.h"
#include "tools/io/text_cursor.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

constexpr size_t kHeaderBytes = 84;
constexpr size_t kTriangleBytes = 50;

/// The corners of all triangles: a MeshFrame whose positions are [triangle][corner][xyz].
using Soup = MeshFrame;

uint32_t little_endian_word(const char* at) {
  uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | static_cast<uint8_t>(at[i]);
  return bits;
}

Status read_binary(std::string_view bytes, Soup& out) {
  const size_t count = little_endian_word(bytes.data() + kHeaderBytes - 4);
  const size_t held = (bytes.size() - kHeaderBytes) / kTriangleBytes;
  if (count > held) {
    return Status::corrupt("announces " + counted(count, "triangle") + ", holds " + grouped(held) +
                           "; the file is truncated or no STL, export it again");
  }
  if (const size_t left = bytes.size() - kHeaderBytes - count * kTriangleBytes; left > 0) {
    out.notes.push_back(counted(left, "byte") + " behind the last triangle ignored");
  }
  out.positions.reserve(count * 9);
  uint64_t with_attributes = 0;
  for (size_t i = 0; i < count; ++i) {
    const char* const normal = bytes.data() + kHeaderBytes + i * kTriangleBytes;
    for (size_t x = 3; x < 12; ++x) {
      out.positions.push_back(std::bit_cast<float>(little_endian_word(normal + 4 * x)));
    }
    with_attributes += normal[48] != 0 || normal[49] != 0;
  }
  if (with_attributes > 0) out.unkept.push_back({"attribute bytes", with_attributes});
  return {};
}

/// Keywords in any case, words on any lines; only names end with their line.
class StlTextReader {
 public:
  StlTextReader(std::string_view text, Soup& out) : in_(text), out_(out) {}

  Status run() {
    uint64_t solids = 0;
    do {
      if (Status status = read_solid(); !status.ok()) return status;
      ++solids;
      in_.skip_space();
    } while (!in_.done());
    if (solids > 1) out_.unkept.push_back({"solids", solids});
    return {};
  }

 private:
  bool take(std::string_view keyword) {
    in_.skip_space();
    const TextCursor start = in_;
    const std::string_view word = in_.word();
    const bool same = std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                                 [](unsigned char a, char b) { return std::tolower(a) == b; });
    if (!same) in_ = start;
    return same;
  }

  // "endsolid" or "end solid".
  bool take_end(const std::string& what) {
    if (take("end" + what)) return true;
    const TextCursor start = in_;
    const bool there = take("end") && take(what);
    if (!there) in_ = start;
    return there;
  }

  Status missing(const std::string& what) {
    in_.skip_space();
    if (!in_.done()) return in_.unexpected(what);
    return in_.error("endsolid is missing; the file is truncated, export it again");
  }

  Status read_solid() {
    if (!take("solid")) return missing("'solid', with which an STL file in text begins");
    in_.next_line();
    while (!take_end("solid")) {
      if (!take("facet")) return missing("'facet' or 'endsolid'");
      if (Status status = read_facet(); !status.ok()) return status;
    }
    in_.next_line();
    return {};
  }

  Status read_facet() {
    if (take("normal")) {
      for (int axis = 0; axis < 3; ++axis) {  // often wrong, or nan, and not needed
        in_.skip_space();
        in_.word();
      }
    }
    if (!take("outer") || !take("loop")) return missing("'outer loop'");
    for (int corner = 0; corner < 3; ++corner) {
      if (!take("vertex")) return missing("one of the three vertices of a triangle");
      Real x;
      for (int axis = 0; axis < 3; ++axis) {
        in_.skip_space();
        if (!in_.read(x)) return in_.unexpected("one of the three coordinates of a vertex");
        out_.append_coordinate(x);
      }
    }
    if (!take_end("loop")) return missing("'endloop' behind the three vertices of a triangle");
    return take_end("facet") ? Status() : missing("'endfacet'");
  }

  TextCursor in_;
  Soup& out_;
};

Status read_soup(std::string_view bytes, Soup& out) {
  // Binary files may begin with "solid", too, so their size decides, and zeros within what else
  // could be text.
  const bool has_header = bytes.size() >= kHeaderBytes;
  const std::string_view unpadded = bytes.substr(0, bytes.find_last_not_of('\0') + 1);
  const bool has_zeros = unpadded.substr(0, 512).find('\0') != bytes.npos;
  const bool fits = has_header && (bytes.size() - kHeaderBytes) % kTriangleBytes == 0 &&
                    (bytes.size() - kHeaderBytes) / kTriangleBytes ==
                        little_endian_word(bytes.data() + kHeaderBytes - 4);
  if (fits) return read_binary(bytes, out);
  std::string_view text;
  if (Status status = open_text(has_zeros ? bytes : unpadded, text); !status.ok()) return status;
  if (has_header && has_zeros) return read_binary(bytes, out);
  if (const size_t zeros = bytes.size() - unpadded.size(); zeros > 0)
    out.notes.push_back(counted(zeros, "zero byte") + " behind the text ignored");
  return StlTextReader(text, out).run();
}

Status check_finite(const Soup& soup) {
  const auto& p = soup.positions;
  const auto bad = std::find_if_not(p.begin(), p.end(), [](float x) { return std::isfinite(x); });
  if (bad == p.end()) return {};
  return Status::corrupt("triangle " + grouped(static_cast<uint64_t>(bad - p.begin()) / 9 + 1) +
                         " has a coordinate that is not a finite float32 number; repair the "
                         "frame or leave it out");
}

using Position = std::array<float, 3>;

Position point(const Soup& soup, size_t corner) {
  const float* const p = &soup.positions[3 * corner];
  return {p[0], p[1], p[2]};
}

// True where every vertex of the reference has one position over all its corners.
bool fits_reference(const Soup& soup, const Connectivity& reference) {
  if (soup.positions.size() != 3 * reference.corners.size()) return false;
  constexpr size_t kNone = SIZE_MAX;
  std::vector<size_t> first(reference.vertex_count, kNone);
  for (size_t c = 0; c < reference.corners.size(); ++c) {
    size_t& known = first[reference.corners[c]];
    if (known == kNone) known = c;
    if (point(soup, known) != point(soup, c)) return false;
  }
  return true;
}

// Corners at equal positions become one vertex, in the order of their first appearance. By sorting,
// which takes its time on no input.
Connectivity weld(const Soup& soup) {
  struct Corner {
    Position point;
    uint32_t index = 0;
  };
  std::vector<Corner> sorted;
  const auto count = static_cast<uint32_t>(soup.positions.size() / 3);
  sorted.reserve(count);
  for (uint32_t c = 0; c < count; ++c) sorted.push_back({point(soup, c), c});
  std::sort(sorted.begin(), sorted.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.point, a.index) < std::tie(b.point, b.index);
  });
  std::vector<uint32_t> first(count);
  for (uint32_t i = 0; i < count; ++i) {
    const bool same = i > 0 && sorted[i].point == sorted[i - 1].point;
    first[sorted[i].index] = same ? first[sorted[i - 1].index] : sorted[i].index;
  }
  Connectivity out;
  out.face_sizes.assign(count / 3, 3);
  out.corners.resize(count);
  for (uint32_t c = 0; c < count; ++c) {
    out.corners[c] = first[c] == c ? out.vertex_count++ : out.corners[first[c]];
  }
  return out;
}

// Each vertex gets the position of its first corner.
void gather(const Soup& soup, const Connectivity& connectivity, MeshFrame& out) {
  out.positions.resize(size_t{3} * connectivity.vertex_count);
  if (!soup.remainders.empty()) out.remainders.resize(out.positions.size());
  for (size_t c = connectivity.corners.size(); c-- > 0;) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t to = size_t{3} * connectivity.corners[c] + axis;
      out.positions[to] = soup.positions[3 * c + axis];
      if (3 * c + axis < soup.remainders.size()) out.remainders[to] = soup.remainders[3 * c + axis];
    }
  }
}

}  // namespace

Status read_stl(std::string_view bytes, const MeshReference* reference, MeshFrame& out) {
  Soup soup;
  Status status = read_soup(bytes, soup);
  if (status.ok()) status = check_finite(soup);
  if (!status.ok()) return status;
  if (soup.positions.size() / 3 > UINT32_MAX) {
    return Status::corrupt("more than 1,431,655,765 triangles; split the mesh");
  }
  out.unkept = std::move(soup.unkept);
  out.notes = std::move(soup.notes);
  out.same_connectivity = reference != nullptr && fits_reference(soup, reference->connectivity);
  if (!out.same_connectivity) out.connectivity = weld(soup);
  gather(soup, out.same_connectivity ? reference->connectivity : out.connectivity, out);
  return {};
}

}  // namespace reeb::tools
