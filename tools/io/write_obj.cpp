#include <array>
#include <climits>

#include "tools/io/attribute_values.h"
#include "tools/io/mesh_file.h"
#include "tools/io/obj_faces.h"
#include "tools/io/text_writer.h"

namespace reeb::tools {
namespace {

/// A name of foreign origin as it may stand in a line.
std::string one_line(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20) c = '_';
  }
  if (name.ends_with('\\')) name.back() = '_';
  return name;
}

/// `vt` or `vn`.
struct WrittenList {
  std::vector<uint32_t> entry_of_corner;  ///< empty: there is no list
  std::vector<uint8_t> none;              ///< faces without; empty: all have values

  bool has(size_t face) const {
    return !entry_of_corner.empty() && (none.empty() || none[face] == 0);
  }
};

/// A statement in front of faces, written where it changes.
struct WrittenState {
  std::string_view keyword;
  const Attribute* attribute = nullptr;
  int64_t now = -1;
};

class ObjWriter {
 public:
  ObjWriter(const Connectivity& connectivity, std::span<const float> positions,
            std::span<const Attribute> attributes)
      : connectivity_(connectivity), positions_(positions), attributes_(attributes) {}

  std::string run() {
    write_libraries();
    write_vertices();
    write_list("vt", Semantic::kTextureCoordinate, 3, lists_[0]);
    write_list("vn", Semantic::kNormal, 3, lists_[1]);
    find_states();
    size_t face = 0;
    size_t corner = 0;
    for_each_face(connectivity_, [&](std::span<const uint32_t> vertices) {
      for (WrittenState& state : states_) write_state(state, face);
      write_face(vertices, face++, corner);
      corner += vertices.size();
    });
    return std::move(out_);
  }

  void list_unkept(std::vector<std::string>* unkept) const {
    list_unwritten(attributes_, written_, unkept);
  }

 private:
  const Attribute* take(const Attribute* a) {
    if (a != nullptr) written_.push_back(a);
    return a;
  }

  void write_libraries() {
    const Attribute* a = attribute_named(attributes_, "mtllib");
    if (a == nullptr || a->domain != Domain::kShot || a->channel_count != 1) return;
    take(a);
    const double value = stored_number(*a, 0);
    if (!(value >= 0) || value >= static_cast<double>(a->names.size())) return;
    const std::string& all = a->names[static_cast<size_t>(value)];
    for (size_t first = 0; first < all.size();) {
      const size_t end = std::min(all.find('\n', first), all.size());
      out_ += "mtllib " + one_line(all.substr(first, end - first)) + '\n';
      first = end + 1;
    }
  }

  void write_vertices() {
    const Attribute* extras = find_attribute(attributes_, [](const Attribute& a) {
      return a.domain == Domain::kVertex && a.semantic == Semantic::kColour &&
             (a.channel_count == 3 || a.channel_count == 4);
    });
    if (extras == nullptr) {
      extras = find_attribute(attributes_, [](const Attribute& a) {
        return a.name == "w" && a.domain == Domain::kVertex && a.channel_count == 1;
      });
    }
    take(extras);
    for (size_t v = 0; v < connectivity_.vertex_count; ++v) {
      out_ += 'v';
      for (size_t axis = 0; axis < 3; ++axis) append(positions_[3 * v + axis]);
      for (size_t i = 0; extras != nullptr && i < extras->channel_count; ++i)
        append(number_of(*extras, v * extras->channel_count + i));
      out_ += '\n';
    }
  }

  void append(float x) {
    out_ += ' ';
    append_number(out_, x);
  }

  const Attribute* list_values(Semantic semantic, uint32_t most) const {
    for (const Domain domain : {Domain::kCorner, Domain::kVertex}) {
      const Attribute* a = find_attribute(attributes_, [&](const Attribute& b) {
        return b.semantic == semantic && b.domain == domain && b.channel_count <= most &&
               (semantic != Semantic::kNormal || b.channel_count == 3);
      });
      if (a != nullptr) return a;
    }
    return nullptr;
  }

  // Values of the corners, one after another.
  std::vector<float> at_corners(const Attribute& a) const {
    std::vector<float> out;
    out.reserve(connectivity_.corners.size() * a.channel_count);
    for (size_t c = 0; c < connectivity_.corners.size(); ++c) {
      const size_t element = a.domain == Domain::kVertex ? connectivity_.corners[c] : c;
      for (size_t i = 0; i < a.channel_count; ++i)
        out.push_back(number_of(a, element * a.channel_count + i));
    }
    return out;
  }

  void write_list(const std::string& keyword, Semantic semantic, uint32_t most, WrittenList& list) {
    const Attribute* a = take(list_values(semantic, most));
    if (a == nullptr) return;
    const std::vector<float> values = at_corners(*a);
    const size_t corners = connectivity_.corners.size();
    const size_t bytes = a->channel_count * sizeof(float);
    const auto* first = reinterpret_cast<const uint8_t*>(values.data());
    const Attribute* none = attribute_named(attributes_, keyword + ".none");
    if (none != nullptr && none->domain == Domain::kFace && none->type == ValueType::kU8) {
      list.none = none->values;
      take(none);
    }
    ListOrder order;
    const Attribute* index = attribute_named(attributes_, keyword + ".index");
    const bool told = index != nullptr && order_as_told(*index, list, first, bytes, order);
    if (told)
      take(index);
    else
      order = plain_order(first, corners, bytes);
    list.entry_of_corner = std::move(order.entry_of_corner);
    if (!told) renumber(list, order.corner_of_entry);
    for (const uint32_t corner : order.corner_of_entry) {
      out_ += keyword;
      for (size_t i = 0; i < a->channel_count; ++i) append(values[corner * a->channel_count + i]);
      out_ += '\n';
    }
  }

  // Leaves entries out that only faces without values have.
  void renumber(WrittenList& list, std::vector<uint32_t>& corner_of_entry) const {
    if (list.none.empty()) return;
    std::vector<uint8_t> used(corner_of_entry.size());
    size_t corner = 0;
    for (size_t f = 0; f < connectivity_.face_sizes.size(); ++f) {
      for (uint32_t i = 0; i < connectivity_.face_sizes[f]; ++i, ++corner) {
        if (list.none[f] == 0) used[list.entry_of_corner[corner]] = 1;
      }
    }
    std::vector<uint32_t> number(used.size());
    std::vector<uint32_t> kept;
    for (size_t e = 0; e < used.size(); ++e) {
      number[e] = static_cast<uint32_t>(kept.size());
      if (used[e] != 0) kept.push_back(corner_of_entry[e]);
    }
    for (uint32_t& entry : list.entry_of_corner) entry = number[entry];
    corner_of_entry = std::move(kept);
  }

  // False where the attribute does not fit the values: entries have one value each, and no number
  // is left out.
  bool order_as_told(const Attribute& index, const WrittenList& list, const uint8_t* values,
                     size_t bytes, ListOrder& out) const {
    const size_t corners = connectivity_.corners.size();
    out = {};
    if (index.domain != Domain::kCorner || index.type != ValueType::kI32 ||
        index.channel_count != 1)
      return false;
    out.corner_of_entry.assign(corners, UINT32_MAX);
    size_t entries = 0;
    size_t found = 0;
    size_t c = 0;
    for (size_t f = 0; f < connectivity_.face_sizes.size(); ++f) {
      const bool has_none = !list.none.empty() && list.none[f] != 0;
      for (uint32_t i = 0; i < connectivity_.face_sizes[f]; ++i, ++c) {
        const int64_t e = has_none ? 0 : index.get<int32_t>(c);
        if (e < 0 || e >= static_cast<int64_t>(corners)) return false;
        const auto entry = static_cast<size_t>(e);
        out.entry_of_corner.push_back(static_cast<uint32_t>(entry));
        if (has_none) continue;
        uint32_t& first = out.corner_of_entry[entry];
        if (first == UINT32_MAX) {
          first = static_cast<uint32_t>(c);
          entries = std::max(entries, entry + 1);
          ++found;
        }
        if (std::memcmp(values + first * bytes, values + c * bytes, bytes) != 0) return false;
      }
    }
    out.corner_of_entry.resize(entries);
    return found == entries;
  }

  void find_states() {
    const auto of_faces = [](const Attribute& a) {
      return a.domain == Domain::kFace && a.channel_count == 1 && a.type != ValueType::kBinary32;
    };
    const auto named = [&](const char* name) {
      const Attribute* a = attribute_named(attributes_, name);
      return a != nullptr && of_faces(*a) ? a : nullptr;
    };
    const Attribute* groups = named("g");
    if (groups == nullptr) {
      groups = find_attribute(attributes_, [&](const Attribute& a) {
        return of_faces(a) && a.semantic == Semantic::kGroup && a.name != "o" && a.name != "s" &&
               !a.name.ends_with(".none");
      });
    }
    const Attribute* material = find_attribute(attributes_, [&](const Attribute& a) {
      return of_faces(a) && a.semantic == Semantic::kMaterial;
    });
    states_ = {WrittenState{"o", take(named("o"))}, WrittenState{"g", take(groups)},
               WrittenState{"usemtl", take(material)},
               WrittenState{"s", take(named("s")), LLONG_MIN}};
  }

  void write_state(WrittenState& state, size_t face) {
    if (state.attribute == nullptr) return;
    const auto value = static_cast<int64_t>(stored_number(*state.attribute, face));
    if (value == state.now) return;
    state.now = value;
    out_ += state.keyword;
    const std::string name = name_of(state, value);
    if (!name.empty()) out_ += ' ' + name;
    out_ += '\n';
  }

  static std::string name_of(const WrittenState& state, int64_t value) {
    const auto& names = state.attribute->names;
    const bool smoothing = state.keyword == "s";
    if (smoothing && value == 0) return "off";
    if (value < 0 && !smoothing) return {};
    if (!smoothing && static_cast<size_t>(value) < names.size())
      return one_line(names[static_cast<size_t>(value)]);
    return std::to_string(value);
  }

  void write_face(std::span<const uint32_t> vertices, size_t face, size_t first_corner) {
    const bool texture = lists_[0].has(face);
    const bool normal = lists_[1].has(face);
    out_ += 'f';
    for (size_t i = 0; i < vertices.size(); ++i) {
      out_ += ' ';
      append_number(out_, uint64_t{vertices[i]} + 1);
      if (texture || normal) out_ += '/';
      if (texture) append_number(out_, uint64_t{lists_[0].entry_of_corner[first_corner + i]} + 1);
      if (!normal) continue;
      out_ += '/';
      append_number(out_, uint64_t{lists_[1].entry_of_corner[first_corner + i]} + 1);
    }
    out_ += '\n';
  }

  const Connectivity& connectivity_;
  std::span<const float> positions_;
  std::span<const Attribute> attributes_;
  std::vector<const Attribute*> written_;
  std::array<WrittenList, 2> lists_;  ///< `vt`, `vn`
  std::array<WrittenState, 4> states_;
  std::string out_;
};

}  // namespace

std::string write_obj(const Connectivity& connectivity, std::span<const float> positions,
                      std::span<const Attribute> attributes, std::vector<std::string>* unkept) {
  ObjWriter writer(connectivity, positions, attributes);
  std::string out = writer.run();
  writer.list_unkept(unkept);
  return out;
}

}  // namespace reeb::tools
