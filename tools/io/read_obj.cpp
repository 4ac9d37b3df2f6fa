#include <algorithm>
#include <array>

#include "tools/io/mesh_file.h"
#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

struct Statement {
  std::string_view keyword;
  const char* what;  ///< as in Unkept
};

constexpr const char* kFreeForm = "curves and surfaces";
constexpr const char* kDisplay = "display attributes";

/// All statements of Wavefront's description (Advanced Visualizer manual, appendix B1) and its
/// predecessor but vertices and faces.
constexpr std::array kUnkept = {
    Statement{"vt", "texture coordinates"},
    Statement{"vn", "normals"},
    Statement{"usemtl", "materials"},
    Statement{"mtllib", "material libraries"},
    Statement{"g", "groups"},
    Statement{"o", "objects"},
    Statement{"s", "smoothing groups"},
    Statement{"l", "lines"},
    Statement{"p", "points"},
    Statement{"usemap", "texture maps"},
    Statement{"maplib", "texture maps"},
    Statement{"call", "included files"},
    Statement{"csh", "commands"},
    Statement{"vp", kFreeForm},
    Statement{"mg", kFreeForm},
    Statement{"cstype", kFreeForm},
    Statement{"deg", kFreeForm},
    Statement{"bmat", kFreeForm},
    Statement{"step", kFreeForm},
    Statement{"curv", kFreeForm},
    Statement{"curv2", kFreeForm},
    Statement{"surf", kFreeForm},
    Statement{"parm", kFreeForm},
    Statement{"trim", kFreeForm},
    Statement{"hole", kFreeForm},
    Statement{"scrv", kFreeForm},
    Statement{"sp", kFreeForm},
    Statement{"end", kFreeForm},
    Statement{"con", kFreeForm},
    Statement{"bsp", kFreeForm},
    Statement{"bzp", kFreeForm},
    Statement{"cdc", kFreeForm},
    Statement{"cdp", kFreeForm},
    Statement{"res", kFreeForm},
    Statement{"bevel", kDisplay},
    Statement{"c_interp", kDisplay},
    Statement{"d_interp", kDisplay},
    Statement{"lod", kDisplay},
    Statement{"shadow_obj", kDisplay},
    Statement{"trace_obj", kDisplay},
    Statement{"ctech", kDisplay},
    Statement{"stech", kDisplay},
};

/// Kinds of statements that are passed over without being known.
constexpr size_t kMaxUnknown = 16;

class ObjReader {
 public:
  ObjReader(std::string_view text, const MeshReference* reference, MeshFrame& out)
      : text_(text), in_(text), reference_(reference), out_(out) {}

  Status run() {
    Status status;
    while (!in_.done() && status.ok() && !out_.same_connectivity) {
      in_.skip_blanks();
      status = read_statement();
      if (!out_.same_connectivity) in_.next_line();
    }
    out_.connectivity.vertex_count = vertex_count();
    if (first_face_ != text_.npos && !vertex_after_face_) {
      out_.face_text = text_.substr(first_face_);
    }
    list_unkept();
    return status;
  }

 private:
  // Up to the end of its last line.
  Status read_statement() {
    const char first = in_.peek();
    if (first == 'v' && is_blank(in_.peek(1))) return read_vertex();
    if (first == 'f' && is_blank(in_.peek(1))) return read_face();
    if (in_.at_line_end()) return {};
    return first == '#' ? skip_comment() : read_other();
  }

  // It ends with its line, even behind a backslash.
  Status skip_comment() {
    in_.skip_to_line_end();
    return {};
  }

  bool at_statement_end() const { return in_.at_line_end() || in_.peek() == '#'; }

  Status read_vertex() {
    in_.advance(1);
    Real x;
    for (int axis = 0; axis < 3; ++axis) {
      in_.skip_blanks_and_continuations();
      if (!in_.read(x)) return in_.unexpected("one of the three coordinates of a vertex");
      out_.append_coordinate(x);
    }
    vertex_after_face_ = first_face_ != text_.npos;
    in_.skip_blanks_and_continuations();
    return at_statement_end() ? skip_comment() : read_vertex_extras();
  }

  // Behind the coordinates: a weight, or a colour of three or four channels.
  Status read_vertex_extras() {
    int count = 0;
    Real x;
    for (; !at_statement_end(); in_.skip_blanks_and_continuations(), ++count) {
      if (!in_.read(x)) return in_.unexpected("a weight or a channel of a colour");
    }
    if (count == 2 || count > 4) {
      return in_.error("a vertex of " + std::to_string(3 + count) +
                       " numbers: it has 3 coordinates, and may have a weight or a colour; export "
                       "the file again");
    }
    if (count == 1) weights_ += x.value != 1;
    if (count > 1) ++colours_;
    return skip_comment();
  }

  Status read_face() {
    if (first_face_ == text_.npos) {
      first_face_ = in_.offset();
      if (matches_reference()) {
        out_.same_connectivity = true;
        return {};
      }
    }
    in_.word();
    uint32_t size = 0;
    for (in_.skip_blanks_and_continuations(); !at_statement_end();
         in_.skip_blanks_and_continuations()) {
      if (Status status = read_corner(); !status.ok()) return status;
      ++size;
    }
    if (size == 0) return in_.error("a face without vertices; leave it out");
    out_.connectivity.face_sizes.push_back(size);
    return skip_comment();
  }

  // v, v/vt, v//vn or v/vt/vn.
  Status read_corner() {
    const TextCursor start = in_;
    int64_t index = 0;
    bool good = in_.read_prefix(index);
    for (int i = 0; i < 2 && in_.peek() == '/'; ++i) {
      in_.advance(1);
      in_.skip_integer();
    }
    good = good && in_.at_number_end();
    if (!good) return start.unexpected("a vertex of a face");
    // Negative numbers count back from the vertex read last.
    const int64_t vertex = index > 0 ? index - 1 : int64_t{vertex_count()} + index;
    if (index == 0 || vertex < 0 || vertex > UINT32_MAX) {
      return start.error("a face uses vertex " + std::to_string(index) +
                         ", which cannot exist; the file is damaged, export it again");
    }
    out_.connectivity.corners.push_back(static_cast<uint32_t>(vertex));
    return {};
  }

  Status read_other() {
    const TextCursor start = in_;
    const std::string_view keyword = in_.word();
    if (keyword == "fo") {  // the predecessor's name of a face
      in_ = start;
      return read_face();
    }
    size_t i = 0;
    while (i < kUnkept.size() && kUnkept[i].keyword != keyword) ++i;
    if (i == kUnkept.size()) {
      const bool word = std::all_of(keyword.begin(), keyword.end(), is_keyword_letter);
      if (!word || out_.unkept.size() == kMaxUnknown) {
        return start.unexpected("a statement of OBJ");
      }
      count_unkept("statements '" + std::string(keyword.substr(0, 40)) + "'", 1);
    } else {
      ++counts_[i];
    }
    in_.skip_continued_line();
    return {};
  }

  static bool is_keyword_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  }

  void count_unkept(const std::string& name, uint64_t count) {
    if (count == 0) return;
    for (Unkept& u : out_.unkept) {
      if (u.name != name) continue;
      u.count += count;
      return;
    }
    out_.unkept.push_back({name, count});
  }

  void list_unkept() {
    count_unkept("colours", colours_);
    count_unkept("weights", weights_);
    for (size_t i = 0; i < kUnkept.size(); ++i) count_unkept(kUnkept[i].what, counts_[i]);
  }

  uint32_t vertex_count() const { return static_cast<uint32_t>(out_.positions.size() / 3); }

  // Equal text behind an equal number of vertices means equal faces.
  bool matches_reference() const {
    return reference_ != nullptr && !reference_->face_text.empty() &&
           vertex_count() == reference_->connectivity.vertex_count &&
           text_.substr(first_face_) == reference_->face_text;
  }

  std::string_view text_;
  TextCursor in_;
  const MeshReference* reference_;
  MeshFrame& out_;
  size_t first_face_ = std::string_view::npos;
  bool vertex_after_face_ = false;
  uint64_t colours_ = 0;
  uint64_t weights_ = 0;
  std::array<uint64_t, kUnkept.size()> counts_{};  ///< statements of each kind
};

}  // namespace

Status read_obj(std::string_view bytes, const MeshReference* reference, MeshFrame& out) {
  std::string_view text;
  if (Status status = open_text(bytes, text); !status.ok()) return status;
  if (reference != nullptr) out.positions.reserve(size_t{3} * reference->connectivity.vertex_count);
  return ObjReader(text, reference, out).run();
}

}  // namespace reeb::tools
