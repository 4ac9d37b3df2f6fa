#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "tools/io/attribute_values.h"
#include "tools/io/mesh_file.h"
#include "tools/io/obj_faces.h"
#include "tools/io/text_cursor.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

struct Statement {
  std::string_view keyword;
  const char* what;  ///< as in Unkept
};

constexpr const char* kFreeForm = "curves and surfaces";
constexpr const char* kDisplay = "display attributes";

/// All statements of Wavefront's description (Advanced Visualizer manual, appendix B1) and its
/// predecessor but those that are kept.
constexpr std::array kUnkept = {
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
    if (!status.ok()) return status;
    out_.connectivity.vertex_count = vertex_count();
    if (first_face_ != text_.npos && !vertex_after_face_ && !entry_after_face_) {
      out_.face_text = text_.substr(first_face_);
    }
    list_unkept();
    add_attributes();
    return {};
  }

 private:
  // Up to the end of its last line.
  Status read_statement() {
    const char first = in_.peek();
    if (first == 'v' && ends_keyword(1)) return read_vertex();
    if (first == 'f' && ends_keyword(1)) return read_face(1);
    if (first == 'v' && ends_keyword(2)) {
      if (in_.peek(1) == 't') return read_entry(lists_[0], 1);
      if (in_.peek(1) == 'n') return read_entry(lists_[1], 3);
    }
    if (in_.at_line_end()) return {};
    return first == '#' ? skip_comment() : read_other();
  }

  bool ends_keyword(size_t size) const {
    const char c = in_.peek(size);
    return is_blank(c) || is_line_end(c) || c == '\\' || size == in_.remaining();
  }

  // Up to a blank, the end of the line or a backslash behind which the line continues.
  std::string_view read_word() {
    const TextCursor start = in_;
    std::string_view word = in_.word();
    TextCursor behind = in_;
    behind.skip_blanks();
    if (!word.ends_with('\\') || !behind.at_line_end() || behind.done()) return word;
    word.remove_suffix(1);
    in_ = start;
    in_.advance(word.size());
    return word;
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
    std::array<float, 4> extras{1, 1, 1, 1};
    Real x;
    for (; !at_statement_end(); in_.skip_blanks_and_continuations(), ++count) {
      if (!in_.read(x)) return in_.unexpected("a weight or a channel of a colour");
      if (count < 4) extras[static_cast<size_t>(count)] = x.value;
    }
    if (count == 2 || count > 4) {
      return in_.error("a vertex of " + std::to_string(3 + count) +
                       " numbers: it has 3 coordinates, and may have a weight or a colour; export "
                       "the file again");
    }
    const size_t vertex = vertex_count() - 1;
    if (count == 1) {
      weights_.resize(vertex, 1.0f);
      weights_.push_back(x.value);
    } else {
      colours_.resize(4 * vertex, 1.0f);
      colours_.insert(colours_.end(), extras.begin(), extras.end());
      colour_channels_ = std::max(colour_channels_, static_cast<uint32_t>(count));
      ++coloured_;
    }
    return skip_comment();
  }

  // `vt` or `vn`.
  Status read_entry(ObjList& list, uint32_t least) {
    in_.advance(2);
    std::array<float, 3> entry{};
    uint32_t count = 0;
    bool finite = true;
    for (in_.skip_blanks_and_continuations(); !at_statement_end();
         in_.skip_blanks_and_continuations(), ++count) {
      Real x;
      if (!in_.read(x)) {  // what some print for what is no number
        in_.word();
        x.value = NAN;
      }
      finite = finite && std::isfinite(x.value);
      if (count < 3) entry[count] = x.value;
    }
    if (count < least) return in_.unexpected("a number of a texture coordinate or normal");
    if (!finite) entry = {};
    list.not_finite += finite ? 0 : 1;
    list.beyond += count > 3 ? count - 3 : 0;
    list.channels = std::max(list.channels, std::min(count, 3u));
    list.values.insert(list.values.end(), entry.begin(), entry.end());
    entry_after_face_ = first_face_ != text_.npos;
    return skip_comment();
  }

  // Behind a keyword of so many letters.
  Status read_face(size_t keyword) {
    if (first_face_ == text_.npos) {
      first_face_ = in_.offset();
      faces_->begin(lists_);
      if (matches_reference()) {
        out_.same_connectivity = true;
        return {};
      }
    }
    in_.advance(keyword);
    const size_t face = out_.connectivity.face_sizes.size();
    for (ObjNames& names : faces_->names) names.take(face);
    faces_->smoothing.take(face);
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
    std::array<int64_t, 2> entries{};  // 0: none
    for (size_t i = 0; i < 2 && in_.peek() == '/'; ++i) {
      in_.advance(1);
      if (in_.peek() != '/' && !in_.at_number_end()) good = good && in_.read_prefix(entries[i]);
    }
    good = good && in_.at_number_end();
    if (!good) return start.unexpected("a vertex of a face");
    // Negative numbers count back from the vertex read last.
    const int64_t vertex = index > 0 ? index - 1 : int64_t{vertex_count()} + index;
    if (index == 0 || vertex < 0 || vertex > UINT32_MAX) {
      return start.error("a face uses vertex " + std::to_string(index) +
                         ", which cannot exist; the file is damaged, export it again");
    }
    for (size_t i = 0; i < 2; ++i) set_entry(i, entries[i]);
    out_.connectivity.corners.push_back(static_cast<uint32_t>(vertex));
    return {};
  }

  // Of the corner that follows; 0: none.
  void set_entry(size_t list, int64_t index) {
    const int64_t entry = index > 0 ? index - 1 : static_cast<int64_t>(lists_[list].size()) + index;
    const bool possible = index != 0 && entry >= 0 && entry <= INT32_MAX;
    if (index != 0 && !possible) ++faces_->unreadable[list];
    faces_->set_entry(list, out_.connectivity.corners.size(),
                      possible ? static_cast<int32_t>(entry) : ObjList::kNone);
  }

  Status read_other() {
    const TextCursor start = in_;
    const std::string_view keyword = read_word();
    if (keyword == "fo") {  // the predecessor's name of a face
      in_ = start;
      return read_face(keyword.size());
    }
    if (read_name(keyword)) return {};
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

  // A statement that names what the faces after it belong to.
  bool read_name(std::string_view keyword) {
    ObjNames* names = nullptr;
    if (keyword == "usemtl") names = &faces_->names[ObjFaces::kMaterial];
    if (keyword == "g") names = &faces_->names[ObjFaces::kGroup];
    if (keyword == "o") names = &faces_->names[ObjFaces::kObject];
    if (keyword == "s") names = &faces_->smoothing;
    if (names == nullptr && keyword != "mtllib") return false;
    const std::string name = rest_of_line();
    if (names != nullptr)
      names->set(name);
    else if (!name.empty())
      (first_face_ == text_.npos ? libraries_ : faces_->libraries).push_back(name);
    return true;
  }

  // Its words as they stand; blanks, and the ends of lines that continue, are one blank each.
  std::string rest_of_line() {
    std::string out;
    for (in_.skip_blanks_and_continuations(); !in_.at_line_end();
         in_.skip_blanks_and_continuations()) {
      if (!out.empty()) out += ' ';
      out += read_word();
    }
    return out;
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
    for (size_t i = 0; i < kUnkept.size(); ++i) count_unkept(kUnkept[i].what, counts_[i]);
  }

  void add_attributes() {
    add_vertex_attributes();
    const bool same = out_.same_connectivity;
    out_.obj_faces = same ? reference_->obj_faces : faces_;
    add_obj_attributes(lists_, *out_.obj_faces, libraries_,
                       same ? reference_->connectivity : out_.connectivity, out_);
  }

  void add_vertex_attributes() {
    if (coloured_ > 0) {
      colours_.resize(size_t{4} * vertex_count(), 1.0f);
      std::vector<float> channels;
      for (size_t i = 0; i < colours_.size(); ++i) {
        if (i % 4 < colour_channels_) channels.push_back(colours_[i]);
      }
      add_values("color", Semantic::kColour, colour_channels_, channels);
      if (coloured_ < vertex_count())
        out_.notes.push_back(grouped(vertex_count() - coloured_) +
                             " of the vertices have no colour, which is taken as white");
    }
    weights_.resize(weights_.empty() ? 0 : vertex_count(), 1.0f);
    if (std::any_of(weights_.begin(), weights_.end(), [](float w) { return w != 1; }))
      add_values("w", Semantic::kGeneric, 1, weights_);
  }

  void add_values(const char* name, Semantic semantic, uint32_t channels,
                  std::vector<float>& values) {
    out_.zero_not_finite(name, values);
    out_.attributes.push_back(
        make_attribute(name, semantic, Domain::kVertex, ValueType::kBinary32, channels, values));
  }

  uint32_t vertex_count() const { return static_cast<uint32_t>(out_.positions.size() / 3); }

  // Equal text behind an equal number of vertices means equal faces.
  bool matches_reference() const {
    return reference_ != nullptr && !reference_->face_text.empty() && reference_->obj_faces &&
           vertex_count() == reference_->connectivity.vertex_count &&
           text_.substr(first_face_) == reference_->face_text &&
           faces_->begins_like(*reference_->obj_faces);
  }

  std::string_view text_;
  TextCursor in_;
  const MeshReference* reference_;
  MeshFrame& out_;
  size_t first_face_ = std::string_view::npos;
  bool vertex_after_face_ = false;
  bool entry_after_face_ = false;
  std::vector<float> colours_;  ///< four to a vertex, up to the last one that has them
  uint32_t colour_channels_ = 0;
  size_t coloured_ = 0;  ///< vertices
  std::vector<float> weights_;
  std::array<ObjList, 2> lists_;        ///< `vt`, `vn`
  std::vector<std::string> libraries_;  ///< before the first face
  std::shared_ptr<ObjFaces> faces_ = std::make_shared<ObjFaces>();
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
