#include "tools/io/ply_attributes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <utility>

#include "bitstream/utf8.h"
#include "tools/io/attribute_values.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

struct Family {
  std::vector<std::string_view> names;
  Semantic semantic;
};

/// Properties that belong together, the longest first.
const std::vector<Family>& families() {
  static const std::vector<Family> all{
      {{"red", "green", "blue", "alpha"}, Semantic::kColour},
      {{"red", "green", "blue"}, Semantic::kColour},
      {{"r", "g", "b", "a"}, Semantic::kColour},
      {{"r", "g", "b"}, Semantic::kColour},
      {{"nx", "ny", "nz"}, Semantic::kNormal},
      {{"tx", "ty", "tz"}, Semantic::kTangent},
      {{"vx", "vy", "vz"}, Semantic::kVelocity},
      {{"s", "t"}, Semantic::kTextureCoordinate},
      {{"u", "v"}, Semantic::kTextureCoordinate},
      {{"texture_u", "texture_v"}, Semantic::kTextureCoordinate},
  };
  return all;
}

bool is_geometry(const PlyElement& element, const std::string& name) {
  if (element.name == "vertex") return name == "x" || name == "y" || name == "z";
  return name == "vertex_indices" || name == "vertex_index";
}

ValueType value_type(PlyType type, bool normalised) {
  switch (type) {
    case PlyType::kUint8:
      return normalised ? ValueType::kU8Normalised : ValueType::kU8;
    case PlyType::kUint16:
      return normalised ? ValueType::kU16Normalised : ValueType::kU16;
    case PlyType::kFloat:
    case PlyType::kDouble:
      return ValueType::kBinary32;
    default:
      return ValueType::kI32;
  }
}

/// The family that begins with property `first`, or nullptr.
const Family* family_at(const PlyElement& element, size_t first) {
  for (const Family& family : families()) {
    if (first + family.names.size() > element.properties.size()) continue;
    bool fits = true;
    for (size_t i = 0; i < family.names.size() && fits; ++i) {
      const PlyProperty& p = element.properties[first + i];
      fits = p.name == family.names[i] && !p.is_list && p.type == element.properties[first].type;
    }
    if (fits) return &family;
  }
  return nullptr;
}

Semantic semantic_of(const PlyElement& element, const PlyProperty& property) {
  const bool material = property.name == "material_index" || property.name == "material";
  const bool whole = value_type(property.type, false) != ValueType::kBinary32;
  return element.name == "face" && material && whole ? Semantic::kMaterial : Semantic::kGeneric;
}

}  // namespace

PlyAttributes::PlyAttributes(const PlyElement& element, Domain domain, size_t most)
    : element_(element), attribute_of_(element.properties.size(), kNone) {
  for (size_t i = 0; i < element.properties.size();) {
    const PlyProperty& first = element.properties[i];
    const Family* family = family_at(element, i);
    const size_t count = family != nullptr ? family->names.size() : 1;
    std::string name = first.name;
    for (size_t k = 1; k < count; ++k) name += " " + element.properties[i + k].name;
    const bool kept = !first.is_list && first.type != PlyType::kUnknown &&
                      !is_geometry(element, first.name) && attributes_.size() < most &&
                      attribute_named(attributes_, name) == nullptr && is_utf8(name) &&
                      name.size() <= kMaxAttributeName;
    if (kept) {
      std::fill_n(attribute_of_.begin() + static_cast<std::ptrdiff_t>(i), count,
                  attributes_.size());
      const bool colour = family != nullptr && family->semantic == Semantic::kColour;
      attributes_.push_back(
          make_attribute(name, family != nullptr ? family->semantic : semantic_of(element, first),
                         domain, value_type(first.type, colour), static_cast<uint32_t>(count)));
    }
    i += count;
  }
  changed_.resize(attributes_.size());
}

void PlyAttributes::append(size_t target, uint32_t bits, size_t size) {
  auto& values = attributes_[target].values;
  std::array<uint8_t, 4> bytes;
  if (size == 1) {
    bytes[0] = static_cast<uint8_t>(bits);
  } else if (size == 2) {
    const auto small = static_cast<uint16_t>(bits);
    std::memcpy(bytes.data(), &small, 2);
  } else {
    std::memcpy(bytes.data(), &bits, 4);
  }
  values.insert(values.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
}

void PlyAttributes::add(size_t target, const Real& x) {
  const bool finite = std::isfinite(x.value);
  changed_[target] += !finite || x.remainder != 0;
  append(target, std::bit_cast<uint32_t>(finite ? x.value : 0.0f), 4);
}

void PlyAttributes::add(size_t target, int64_t x) {
  int64_t low = INT32_MIN, high = INT32_MAX;
  const size_t size = size_of(attributes_[target].type);
  if (size < 4) {
    low = 0;
    high = size == 1 ? UINT8_MAX : UINT16_MAX;
  }
  const int64_t kept = std::clamp(x, low, high);
  changed_[target] += kept != x;
  append(target, static_cast<uint32_t>(kept), size);
}

void PlyAttributes::finish(MeshFrame& out) {
  for (size_t i = 0; i < attribute_of_.size(); ++i) {
    const PlyProperty& p = element_.properties[i];
    if (attribute_of_[i] == kNone && !is_geometry(element_, p.name))
      out.unkept.push_back({(p.is_list ? "list " : "") + p.name, element_.count});
  }
  for (size_t a = 0; a < attributes_.size(); ++a) {
    if (changed_[a] > 0) {
      const bool real = attributes_[a].type == ValueType::kBinary32;
      out.notes.push_back(counted(changed_[a], "number") + " of \"" + attributes_[a].name +
                          (real ? "\" rounded to binary32, or 0 for what is not finite"
                                : "\" beyond 32 bits or the type, taken as the nearest within"));
    }
    out.attributes.push_back(std::move(attributes_[a]));
  }
}

namespace {

/// Names of an attribute's channels as PLY may have them.
std::vector<std::string> column_names(const Attribute& a) {
  const std::string_view name = a.name;
  std::vector<std::string> words;
  for (size_t first = 0; first <= name.size();) {
    const size_t end = std::min(name.find(' ', first), name.size());
    words.emplace_back(name.substr(first, end - first));
    first = end + 1;
  }
  if (words.size() == a.channel_count) return words;
  for (const Family& family : families()) {
    if (family.semantic == a.semantic && family.names.size() == a.channel_count &&
        family.semantic != Semantic::kGeneric)
      return {family.names.begin(), family.names.end()};
  }
  std::vector<std::string> out;
  for (uint32_t c = 0; c < a.channel_count; ++c)
    out.push_back(a.channel_count == 1 ? a.name : a.name + "_" + std::to_string(c));
  return out;
}

/// A word, whatever comes.
std::string as_word(const std::string& name) {
  std::string out;
  for (const char c : name) out += static_cast<unsigned char>(c) <= 0x20 ? '_' : c;
  return out.empty() ? "_" : out;
}

const char* type_name(ValueType type) {
  switch (type) {
    case ValueType::kBinary32:
      return "float";
    case ValueType::kU8:
    case ValueType::kU8Normalised:
      return "uchar";
    case ValueType::kU16:
    case ValueType::kU16Normalised:
      return "ushort";
    case ValueType::kI32:
      break;
  }
  return "int";
}

}  // namespace

void PlyColumns::add(const Attribute& attribute) {
  const std::vector<std::string> names = column_names(attribute);
  for (uint32_t c = 0; c < attribute.channel_count; ++c) {
    std::string name = as_word(names[c]);
    const auto taken = [&](const std::string& wanted) {
      return wanted == "x" || wanted == "y" || wanted == "z" || wanted == "vertex_index" ||
             wanted == "vertex_indices" ||
             std::any_of(columns.begin(), columns.end(),
                         [&](const Column& column) { return column.name == wanted; });
    };
    while (taken(name)) name += "_";
    columns.push_back({name, &attribute, c});
  }
}

std::string PlyColumns::header() const {
  std::string out;
  for (const Column& c : columns)
    out += std::string("property ") + type_name(c.attribute->type) + " " + c.name + "\n";
  return out;
}

void PlyColumns::append_row(size_t index, std::string& out) const {
  for (const Column& c : columns) {
    const Attribute& a = *c.attribute;
    const size_t i = index * a.channel_count + c.channel;
    const auto bits = a.type == ValueType::kBinary32
                          ? a.get<uint32_t>(i)
                          : static_cast<uint32_t>(static_cast<int64_t>(stored_number(a, i)));
    for (size_t byte = 0; byte < size_of(a.type); ++byte)
      out.push_back(static_cast<char>(bits >> (8 * byte) & 0xff));
  }
}

Attribute at_vertices(const Attribute& corners, const Connectivity& connectivity) {
  Attribute out = make_attribute(corners.name, corners.semantic, Domain::kVertex, corners.type,
                                 corners.channel_count);
  out.names = corners.names;
  const size_t bytes = corners.element_bytes();
  std::vector<uint8_t> known(connectivity.vertex_count);
  std::vector<uint8_t> values(connectivity.vertex_count * bytes);
  for (size_t c = 0; c < connectivity.corners.size(); ++c) {
    const size_t v = connectivity.corners[c];
    const uint8_t* const value = &corners.values[c * bytes];
    if (known[v] == 0)
      std::memcpy(&values[v * bytes], value, bytes);
    else if (std::memcmp(&values[v * bytes], value, bytes) != 0)
      return out;
    known[v] = 1;
  }
  out.values = std::move(values);
  return out;
}

}  // namespace reeb::tools
