#include <string>

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
    list_unkept();
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
    const bool there = in_.rest().starts_with(letters);
    if (there) in_.advance(letters.size());
    return there;
  }

  // [ST][C][N]OFF. It may be missing, and the first count may be glued to it.
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
    if (by_lines_) return skip_numbers(vertex_extras_);
    const int announced = 2 * texture_coordinates_ + 4 * colours_ + 3 * normals_;
    for (int i = 0; i < announced; ++i) {
      skip_to_content();
      if (!in_.read(x)) return in_.unexpected("a number of a vertex");
    }
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
    return skip_numbers(face_extras_);
  }

  // Up to the end of the line; `rows` counts those with numbers.
  Status skip_numbers(uint64_t& rows) {
    rows += !at_row_end();
    for (Real x; !at_row_end();) {
      if (!in_.read(x)) return in_.unexpected("a number");
    }
    return {};
  }

  void list_unkept() {
    const bool unannounced = !texture_coordinates_ && !colours_ && !normals_;
    const auto list = [&](bool there, const char* what, uint64_t count) {
      if (there && count > 0) out_.unkept.push_back({what, count});
    };
    list(texture_coordinates_, "texture coordinates", vertex_count_);
    list(colours_, "colours", vertex_count_);
    list(normals_, "normals", vertex_count_);
    list(unannounced, "numbers behind the coordinates", vertex_extras_);
    list(true, "colours of faces", face_extras_);
  }

  TextCursor in_;
  MeshFrame& out_;
  bool texture_coordinates_ = false;
  bool colours_ = false;
  bool normals_ = false;
  bool by_lines_ = false;  ///< a line for each vertex and each face
  uint64_t vertex_count_ = 0;
  uint64_t face_count_ = 0;
  uint64_t vertex_extras_ = 0;  ///< vertices with numbers behind the coordinates
  uint64_t face_extras_ = 0;    ///< faces with numbers behind their vertices
};

}  // namespace

Status read_off(std::string_view bytes, MeshFrame& out) {
  std::string_view text;
  if (Status status = open_text(bytes, text); !status.ok()) return status;
  return OffReader(text, out).run();
}

}  // namespace reeb::tools
