#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "tools/io/attribute_values.h"
#include "tools/io/mesh_file.h"
#include "tools/io/text_cursor.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

/// Object File Format of Geomview, ascii, three coordinates.
///
/// Its words may stand on any lines, but then a vertex has just what the keyword announces. Files
/// with a line for each vertex and each face, as nearly all are, may have more on it.
class OffReader {
 public:
  OffReader(std::string_view text, MeshFrame& out) : in_(text), out_(out) {}

  Status run() {
    Status status = read_keyword();
    if (status.ok()) status = read_counts();
    if (!status.ok()) return status;
    by_lines_ = count_lines() == vertex_count_ + face_count_;
    for (uint64_t i = 0; i < vertex_count_ && status.ok(); ++i) status = read_vertex();
    for (uint64_t i = 0; i < face_count_ && status.ok(); ++i) status = read_face();
    if (!status.ok()) return status;
    skip_to_content();
    if (!in_.done()) {
      return in_.error("more follows than the " + counted(vertex_count_, "vertex") + " and " +
                       counted(face_count_, "face") +
                       " that the file announces; it is damaged, export it again");
    }
    out_.connectivity.vertex_count = static_cast<uint32_t>(vertex_count_);
    add_attributes();
    return {};
  }

 private:
  // To the next thing that is neither blank nor comment.
  void skip_to_content() {
    for (in_.skip_space(); in_.peek() == '#'; in_.skip_space()) in_.next_line();
  }
  // To the next thing of the same vertex or face.
  void skip_in_row() { by_lines_ ? in_.skip_blanks() : skip_to_content(); }
  bool at_row_end() {
    in_.skip_blanks();
    return in_.at_line_end() || in_.peek() == '#';
  }
  bool take(std::string_view letters) {
    const std::string_view next = in_.rest().substr(0, letters.size());
    const bool there = std::equal(next.begin(), next.end(), letters.begin(), letters.end(),
                                  [](unsigned char a, char b) { return std::toupper(a) == b; });
    if (there) in_.advance(letters.size());
    return there;
  }

  // [ST][C][N]OFF, in any case. It may be missing, and the first count may be glued to it.
  Status read_keyword() {
    skip_to_content();
    if (is_digit(in_.peek())) return {};
    const TextCursor start = in_;
    texture_coordinates_ = take("ST");
    colours_ = take("C");
    normals_ = take("N");
    const bool known = take("OFF") && (in_.at_number_end() || is_digit(in_.peek()));
    if (!known) {
      return start.error("not an OFF file with three coordinates; it must begin with OFF");
    }
    skip_to_content();
    if (!take("BINARY")) return {};
    return in_.error("binary OFF is not supported; convert it to ascii OFF or to PLY");
  }

  Status read_counts() {
    skip_to_content();
    if (!in_.read(vertex_count_)) return in_.unexpected("the count of vertices");
    skip_to_content();
    if (!in_.read(face_count_)) return in_.unexpected("the count of faces");
    if (Status status = skip_edge_count(); !status.ok()) return status;
    // "0 0 0\n" is the shortest vertex, "1 0\n" the shortest face; the last line may lack its end.
    const size_t size = in_.remaining() + 1;
    if (vertex_count_ > size / 6 || face_count_ > size / 4) {
      return in_.error("the file is shorter than its counts say; it is truncated, export it again");
    }
    return {};
  }

  // It means nothing, and some files lack it: elsewhere than on the line of the other counts it is
  // a number alone.
  Status skip_edge_count() {
    uint64_t edges = 0;
    if (!at_row_end()) return in_.read(edges) ? Status() : in_.unexpected("the count of edges");
    const TextCursor before = in_;
    skip_to_content();
    if (!in_.read(edges) || !at_row_end()) in_ = before;
    return {};
  }

  uint64_t count_lines() const {
    OffReader ahead = *this;
    uint64_t lines = 0;
    for (ahead.skip_to_content(); !ahead.in_.done(); ahead.skip_to_content()) {
      ahead.in_.next_line();
      ++lines;
    }
    return lines;
  }

  Status read_vertex() {
    skip_to_content();
    Real x;
    for (int axis = 0; axis < 3; ++axis, skip_in_row()) {
      if (!in_.read(x)) return in_.unexpected("one of the three coordinates of a vertex");
      out_.append_coordinate(x);
    }
    if (by_lines_) return read_numbers(vertex_extras_);
    const size_t announced = 2u * texture_coordinates_ + 4u * colours_ + 3u * normals_;
    for (size_t i = 0; i < announced; ++i) {
      skip_to_content();
      if (!in_.read(x)) return in_.unexpected("a number of a vertex");
      vertex_extras_.numbers.push_back(x.value);
    }
    vertex_extras_.end_row(announced);
    return {};
  }

  Status read_face() {
    skip_to_content();
    uint64_t size = 0;
    if (!in_.read(size)) return in_.unexpected("the number of vertices of a face");
    if (size == 0) return in_.error("a face without vertices; leave it out");
    for (uint64_t i = 0; i < size; ++i) {
      skip_in_row();
      uint32_t vertex = 0;
      if (!in_.read(vertex)) return in_.unexpected("a vertex of a face");
      out_.connectivity.corners.push_back(vertex);
    }
    out_.connectivity.face_sizes.push_back(static_cast<uint32_t>(size));
    return read_numbers(face_extras_);
  }

  /// Numbers behind those of vertices or faces.
  struct Extras {
    std::vector<float> numbers;
    uint64_t rows = 0;  ///< that have any
    size_t in_row = 0;  ///< numbers of each row, if all have equally many
    bool even = true;
    uint64_t ended = 0;

    void end_row(size_t count) {
      if (ended++ == 0) in_row = count;
      even = even && count == in_row;
      rows += count > 0 ? 1 : 0;
    }
  };

  // Up to the end of the line.
  Status read_numbers(Extras& extras) {
    size_t count = 0;
    for (Real x; !at_row_end(); ++count) {
      if (!in_.read(x)) return in_.unexpected("a number");
      extras.numbers.push_back(x.value);
    }
    extras.end_row(count);
    return {};
  }

  // Channels first .. first + count - 1 of the numbers of each row.
  void add(const char* name, Semantic semantic, Domain domain, const Extras& extras, size_t first,
           size_t count) {
    std::vector<float> values;
    for (size_t row = 0; row < extras.ended; ++row) {
      const auto begin =
          extras.numbers.begin() + static_cast<std::ptrdiff_t>(row * extras.in_row + first);
      values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
    }
    out_.zero_not_finite(name, values);
    const auto channels = static_cast<uint32_t>(count);
    if (semantic != Semantic::kColour || !are_bytes(values)) {
      out_.attributes.push_back(
          make_attribute(name, semantic, domain, ValueType::kBinary32, channels, values));
      return;
    }
    const std::vector<uint8_t> bytes(values.begin(), values.end());
    out_.attributes.push_back(
        make_attribute(name, semantic, domain, ValueType::kU8Normalised, channels, bytes));
  }

  // Colours are whole numbers up to 255, or fractions.
  static bool are_bytes(const std::vector<float>& values) {
    bool above_one = false;
    for (const float x : values) {
      if (!(x >= 0 && x <= 255) || x != std::trunc(x)) return false;
      above_one = above_one || x > 1;
    }
    return above_one;
  }

  void unkept(const char* what, const Extras& extras) {
    if (extras.rows > 0) out_.unkept.push_back({what, extras.rows});
  }

  // In the order of Geomview: normal, colour, texture coordinate.
  void add_attributes() {
    const size_t others = 3u * normals_ + 2u * texture_coordinates_;
    const size_t n = vertex_extras_.in_row;
    const size_t colours = n >= others ? n - others : 0;
    const bool fits = colours_ ? colours == 3 || colours == 4 : n == others;
    if (n == 0 || !vertex_extras_.even || !fits) {
      unkept("numbers behind the coordinates", vertex_extras_);
    } else {
      if (normals_) add("normal", Semantic::kNormal, Domain::kVertex, vertex_extras_, 0, 3);
      if (colours_)
        add("color", Semantic::kColour, Domain::kVertex, vertex_extras_, 3u * normals_, colours);
      if (texture_coordinates_)
        add("st", Semantic::kTextureCoordinate, Domain::kVertex, vertex_extras_, n - 2, 2);
    }
    const size_t m = face_extras_.in_row;
    if (face_extras_.even && (m == 3 || m == 4))
      add("face color", Semantic::kColour, Domain::kFace, face_extras_, 0, m);
    else
      unkept("numbers behind the vertices of faces", face_extras_);
  }

  TextCursor in_;
  MeshFrame& out_;
  bool texture_coordinates_ = false;
  bool colours_ = false;
  bool normals_ = false;
  bool by_lines_ = false;  ///< a line for each vertex and each face
  uint64_t vertex_count_ = 0;
  uint64_t face_count_ = 0;
  Extras vertex_extras_;  ///< behind the coordinates
  Extras face_extras_;    ///< behind the vertices of faces
};

}  // namespace

Status read_off(std::string_view bytes, MeshFrame& out) {
  std::string_view text;
  if (Status status = open_text(bytes, text); !status.ok()) return status;
  return OffReader(text, out).run();
}

}  // namespace reeb::tools
