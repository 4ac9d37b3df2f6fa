#include "tools/io/ply_header.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "tools/io/text_cursor.h"

namespace reeb::tools {
namespace {

std::optional<PlyType> type_named(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{
      {"char", PlyType::kInt8},
      {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},
      {"short", PlyType::kInt16},
      {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},
      {"uint16", PlyType::kUint16},
      {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},
      {"uint", PlyType::kUint32},
      {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat},
      {"float32", PlyType::kFloat},
      {"double", PlyType::kDouble},
      {"float64", PlyType::kDouble},
  }};
  for (const auto& [text, type] : kNames) {
    if (text == name) return type;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view file, PlyHeader& out) : in_(file), out_(out) {}

  Status run() {
    if (next() != "ply") return in_.error("not a PLY file; it must begin with ply");
    for (in_.next_line(); !in_.done(); in_.next_line()) {
      const std::string_view keyword = next();
      if (keyword == "end_header") {
        in_.next_line();
        out_.bytes = in_.offset();
        return {};
      }
      if (Status status = read_line(keyword); !status.ok()) return status;
    }
    return in_.error("end_header is missing; the file is truncated, export it again");
  }

 private:
  std::string_view next() {
    in_.skip_blanks();
    return in_.word();
  }

  Status read_line(std::string_view keyword) {
    if (keyword == "format") return read_format();
    if (keyword == "element") return read_element();
    if (keyword == "property") return read_property();
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return {};
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
      const auto count_type = type_named(next());
      if (!count_type || *count_type >= PlyType::kFloat) return bad_type();
      property.count_type = *count_type;
      type_name = next();
    }
    const auto type = type_named(type_name);
    if (!type) return bad_type();
    property.type = *type;
    property.name = next();
    out_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  Status bad_type() const { return in_.error("unknown type of a PLY property"); }

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
    case PlyType::kDouble:
      return 8;
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
