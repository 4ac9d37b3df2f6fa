#include "tools/io/mesh_file.h"
#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

/// Object File Format of Geomview, ascii, three coordinates; colours, normals and texture
/// coordinates that may follow on a line are skipped.
class OffReader {
 public:
  OffReader(std::string_view bytes, MeshFrame& out) : in_(bytes), out_(out) {}

  Status run() {
    if (Status status = read_header(); !status.ok()) return status;
    for (uint64_t i = 0; i < vertex_count_; ++i) {
      if (Status status = read_vertex(); !status.ok()) return status;
    }
    for (uint64_t i = 0; i < face_count_; ++i) {
      if (Status status = read_face(); !status.ok()) return status;
    }
    out_.connectivity.vertex_count = static_cast<uint32_t>(vertex_count_);
    return {};
  }

 private:
  // To the next thing that is neither blank nor comment.
  void skip_to_content() {
    for (in_.skip_space(); in_.peek() == '#'; in_.skip_space()) in_.next_line();
  }

  Status read_header() {
    skip_to_content();
    const std::string_view keyword = in_.word();
    const bool known = keyword == "OFF" || keyword == "COFF" || keyword == "NOFF" ||
                       keyword == "CNOFF" || keyword == "STOFF" || keyword == "STCOFF" ||
                       keyword == "STNOFF" || keyword == "STCNOFF";
    if (!known) {
      return in_.error("not an OFF file with three coordinates; it must begin with OFF");
    }
    if (keyword != "OFF") out_.dropped = "colours, normals or texture coordinates";
    skip_to_content();
    if (in_.rest().starts_with("BINARY")) {
      return in_.error("binary OFF is not supported; convert it to ascii OFF or to PLY");
    }
    if (!read_count(vertex_count_) || !read_count(face_count_)) {
      return in_.error("the counts of vertices and faces are missing");
    }
    in_.next_line();
    // "0 0 0\n" is the shortest vertex (the last may lack its newline), "0\n" the shortest face.
    if (vertex_count_ > in_.remaining() / 5 || face_count_ > in_.remaining() / 2 + 1) {
      return in_.error("the file is shorter than its counts say; it is truncated, export it again");
    }
    return {};
  }

  bool read_count(uint64_t& value) {
    skip_to_content();
    return in_.read(value);
  }

  Status read_vertex() {
    skip_to_content();
    for (int axis = 0; axis < 3; ++axis) {
      in_.skip_blanks();
      float value = 0;
      if (!in_.read(value)) {
        return in_.error("a vertex needs three numbers; the file is damaged, export it again");
      }
      out_.positions.push_back(value);
    }
    in_.next_line();
    return {};
  }

  Status read_face() {
    skip_to_content();
    uint64_t size = 0;
    if (!in_.read(size) || size == 0) {
      return in_.error("a face must begin with its number of vertices; the file is damaged");
    }
    for (uint64_t i = 0; i < size; ++i) {
      in_.skip_blanks();
      uint64_t vertex = 0;
      if (!in_.read(vertex) || vertex > UINT32_MAX) {
        return in_.error("a face lists fewer vertices than it announces; the file is damaged");
      }
      out_.connectivity.corners.push_back(static_cast<uint32_t>(vertex));
    }
    out_.connectivity.face_sizes.push_back(static_cast<uint32_t>(size));
    in_.next_line();
    return {};
  }

  TextCursor in_;
  MeshFrame& out_;
  uint64_t vertex_count_ = 0;
  uint64_t face_count_ = 0;
};

}  // namespace

Status read_off(std::string_view bytes, MeshFrame& out) { return OffReader(bytes, out).run(); }

}  // namespace reeb::tools
