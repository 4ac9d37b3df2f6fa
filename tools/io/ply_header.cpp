#include "tools/io/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

PlyType type_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 20> kNames{{
      {"char", PlyType::kInt8},     {"int8", PlyType::kInt8},      {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},   {"short", PlyType::kInt16},    {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16},  {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},   {"uint", PlyType::kUint32},    {"uint32", PlyType::kUint32},
      {"int64", PlyType::kInt64},   {"long", PlyType::kInt64},     {"uint64", PlyType::kUint64},
      {"ulong", PlyType::kUint64},  {"float", PlyType::kFloat},    {"float32", PlyType::kFloat},
      {"double", PlyType::kDouble}, {"float64", PlyType::kDouble},
  }};
  for (const auto& [text, type] : kNames) {
    if (text == name) return type;
  }
  return PlyType::kUnknown;
}

bool is_integer(PlyType type) { return type < PlyType::kFloat; }

class HeaderReader {
 public:
  HeaderReader(std::string_view file, PlyHeader& out) : in_(file), out_(out) {}

  Status run() {
    if (next() != "ply") return in_.error("not a PLY file; it must begin with ply");
    const TextCursor first_end = in_;
    in_.next_line();
    while (!in_.done()) {
      const std::string_view keyword = next();
      if (keyword == "end_header") return end_header(first_end);
      if (Status status = read_line(keyword); !status.ok()) return status;
      in_.skip_blanks();
      if (!in_.at_line_end()) return in_.unexpected("the end of the line");
      in_.next_line();
    }
    return in_.error("end_header is missing; the file is truncated, export it again");
  }

 private:
  std::string_view next() {
    in_.skip_blanks();
    return in_.word();
  }

  // Binary data may begin with what looks like an end of line, so this one is as the first.
  Status end_header(const TextCursor& first_end) {
    in_.skip_blanks();
    const auto ends_in = [](const TextCursor& at, std::string_view end) {
      return at.rest().starts_with(end);
    };
    const bool lone_return = ends_in(first_end, "\r") && !ends_in(first_end, "\r\n");
    if ((ends_in(in_, "\r\n") && !lone_return) ||
        (ends_in(in_, "\n\r") && ends_in(first_end, "\n\r"))) {
      in_.advance(2);
    } else if (in_.at_line_end()) {
      in_.advance(1);
    } else {
      return in_.unexpected("the end of the header");
    }
    if (!has_format_) return in_.error("the header does not tell the format; export it again");
    out_.bytes = in_.offset();
    return check();
  }

  Status read_line(std::string_view keyword) {
    if (keyword == "format") return read_format();
    if (keyword == "element") return read_element();
    if (keyword == "property") return read_property();
    if (keyword == "comment" || keyword == "obj_info") {
      out_.textures += next() == "TextureFile";
      in_.skip_to_line_end();
      return {};
    }
    if (keyword.empty()) return {};
    return in_.error("unknown word '" + std::string(keyword.substr(0, 40)) + "' in the PLY header");
  }

  Status read_format() {
    const std::string_view name = next();
    if (name == "ascii") {
      out_.encoding = PlyEncoding::kAscii;
    } else if (name == "binary_little_endian") {
      out_.encoding = PlyEncoding::kLittleEndian;
    } else if (name == "binary_big_endian") {
      out_.encoding = PlyEncoding::kBigEndian;
    } else {
      return in_.error("unknown PLY format");
    }
    if (next() != "1.0") return in_.error("not PLY 1.0");
    has_format_ = true;
    return {};
  }

  Status read_element() {
    PlyElement element;
    element.name = next();
    in_.skip_blanks();
    if (!in_.read(element.count)) return in_.error("an element needs a name and a count");
    out_.elements.push_back(std::move(element));
    return {};
  }

  Status read_property() {
    if (out_.elements.empty()) return in_.error("a property before any element");
    PlyProperty property;
    std::string_view type_name = next();
    property.is_list = type_name == "list";
    if (property.is_list) {
      property.count_type = type_named(next());
      type_name = next();
    }
    property.type = type_named(type_name);
    property.name = next();
    const bool skippable = out_.encoding == PlyEncoding::kAscii && has_format_;
    if (property.type == PlyType::kUnknown && !skippable) {
      return in_.error("property '" + property.name + "' has the unknown type '" +
                       std::string(type_name.substr(0, 40)) + "'; export the file without it");
    }
    if (property.is_list && !is_integer(property.count_type)) {
      return in_.error("the list '" + property.name + "' is counted in a type that is not whole");
    }
    if (property.name.empty()) return in_.error("a property needs a type and a name");
    out_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  Status check() const {
    for (const std::string_view name : {"vertex", "face"}) {
      const auto named = [&](const PlyElement& e) { return e.name == name; };
      if (std::count_if(out_.elements.begin(), out_.elements.end(), named) > 1) {
        return in_.error("two elements are named " + std::string(name) + "; export the file again");
      }
    }
    for (const PlyElement& element : out_.elements) {
      for (const std::string_view name : {"x", "y", "z", "vertex_indices", "vertex_index"}) {
        const auto named = [&](const PlyProperty& p) { return p.name == name; };
        if (std::count_if(element.properties.begin(), element.properties.end(), named) > 1) {
          return in_.error("two properties of " + element.name + " are named " + std::string(name) +
                           "; export the file again");
        }
      }
    }
    return {};
  }

  bool has_format_ = false;
  TextCursor in_;
  PlyHeader& out_;
};

}  // namespace

size_t ply_size(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt64:
    case PlyType::kUint64:
    case PlyType::kDouble:
      return 8;
    case PlyType::kUnknown:
      return 0;
    default:
      return 4;
  }
}

int PlyElement::find(std::string_view name_a, std::string_view name_b) const {
  for (size_t i = 0; i < properties.size(); ++i) {
    const std::string& candidate = properties[i].name;
    if (candidate == name_a || candidate == name_b) return static_cast<int>(i);
  }
  return -1;
}

size_t PlyElement::min_row_bytes(PlyEncoding encoding) const {
  // In text a value takes a digit and a separator.
  if (encoding == PlyEncoding::kAscii) return 2 * properties.size();
  size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += ply_size(p.is_list ? p.count_type : p.type);
  return bytes;
}

Status read_ply_header(std::string_view file, PlyHeader& out) {
  return HeaderReader(file, out).run();
}

}  // namespace reeb::tools
