#include "tools/io/mesh_file.h"
#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const MeshReference* reference, MeshFrame& out)
      : bytes_(bytes), in_(bytes), reference_(reference), out_(out) {}

  Status run() {
    Status status;
    while (!in_.done() && status.ok() && !out_.same_connectivity) {
      in_.skip_blanks();
      status = read_statement();
      if (!out_.same_connectivity) in_.next_line();
    }
    out_.connectivity.vertex_count = vertex_count();
    if (first_face_ != bytes_.npos && !vertex_after_face_) {
      out_.face_text = bytes_.substr(first_face_);
    }
    out_.dropped = std::move(dropped_);
    return status;
  }

 private:
  Status read_statement() {
    const char first = in_.peek();
    const char second = in_.peek(1);
    if (first == 'v' && TextCursor::is_blank(second)) return read_vertex();
    if (first == 'f' && TextCursor::is_blank(second)) return read_face();
    if (first == 'v' && second == 't') note_dropped("texture coordinates");
    if (first == 'v' && second == 'n') note_dropped("normals");
    if ((first == 'g' || first == 'o') && TextCursor::is_blank(second)) note_dropped("groups");
    if (first == 'u' && in_.rest().starts_with("usemtl")) note_dropped("materials");
    return {};
  }

  Status read_vertex() {
    in_.advance(1);
    for (int axis = 0; axis < 3; ++axis) {
      in_.skip_blanks_and_continuations();
      float value = 0;
      if (!in_.read(value)) {
        return in_.error("a vertex needs three numbers; the file is damaged, export it again");
      }
      out_.positions.push_back(value);
    }
    vertex_after_face_ = first_face_ != bytes_.npos;
    return {};
  }

  Status read_face() {
    if (first_face_ == bytes_.npos) {
      first_face_ = in_.offset();
      if (matches_reference()) {
        out_.same_connectivity = true;
        return {};
      }
    }
    in_.advance(1);
    uint32_t size = 0;
    for (in_.skip_blanks_and_continuations(); !in_.at_line_end() && in_.peek() != '#';
         in_.skip_blanks_and_continuations()) {
      if (Status status = read_corner(); !status.ok()) return status;
      ++size;
    }
    if (size == 0)
      return in_.error("a face without vertices; the file is damaged, export it again");
    out_.connectivity.face_sizes.push_back(size);
    return {};
  }

  Status read_corner() {
    int64_t index = 0;
    if (!in_.read(index)) return in_.error("a face lists something that is not a vertex number");
    if (in_.peek() == '/') in_.word();
    // Negative numbers count back from the vertex read last.
    const int64_t vertex = index > 0 ? index - 1 : int64_t{vertex_count()} + index;
    if (index == 0 || vertex < 0 || vertex > UINT32_MAX) {
      return in_.error("a face uses vertex " + std::to_string(index) +
                       ", which cannot exist; the file is damaged, export it again");
    }
    out_.connectivity.corners.push_back(static_cast<uint32_t>(vertex));
    return {};
  }

  uint32_t vertex_count() const { return static_cast<uint32_t>(out_.positions.size() / 3); }

  // Equal text behind an equal number of vertices means equal faces.
  bool matches_reference() const {
    return reference_ != nullptr && !reference_->face_text.empty() &&
           vertex_count() == reference_->connectivity.vertex_count &&
           bytes_.substr(first_face_) == reference_->face_text;
  }

  void note_dropped(const char* what) {
    if (dropped_.find(what) != std::string::npos) return;
    if (!dropped_.empty()) dropped_ += ", ";
    dropped_ += what;
  }

  std::string_view bytes_;
  TextCursor in_;
  const MeshReference* reference_;
  MeshFrame& out_;
  size_t first_face_ = std::string_view::npos;
  bool vertex_after_face_ = false;
  std::string dropped_;
};

}  // namespace

Status read_obj(std::string_view bytes, const MeshReference* reference, MeshFrame& out) {
  if (reference != nullptr) out.positions.reserve(size_t{3} * reference->connectivity.vertex_count);
  return ObjReader(bytes, reference, out).run();
}

}  // namespace reeb::tools
