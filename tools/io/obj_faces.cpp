#include "tools/io/obj_faces.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>
#include <unordered_map>

#include "bitstream/utf8.h"
#include "tools/io/attribute_values.h"
#include "tools/io/mesh_file.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

constexpr std::array kListNames{"vt", "vn"};
constexpr std::array kListWords{"texture coordinates", "normals"};
constexpr std::array kNameStatements{"usemtl", "g", "o"};
constexpr std::array kNameWords{"materials", "groups", "objects"};

/// `text` as UTF-8; bytes that are none are read as Latin-1.
std::string as_utf8(const std::string& text, uint64_t& converted) {
  if (is_utf8(text)) return text;
  ++converted;
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xc0 | byte >> 6);
      out += static_cast<char>(0x80 | (byte & 0x3f));
    }
  }
  return out;
}

std::vector<std::string> as_utf8(std::vector<std::string> names, MeshFrame& out) {
  uint64_t converted = 0;
  for (std::string& name : names) name = as_utf8(name, converted);
  if (converted > 0)
    out.notes.push_back(counted(converted, "name") + " not in UTF-8, taken as Latin-1");
  return names;
}

/// Corners whose entry the list has; what the others are is said.
class CornerValues {
 public:
  CornerValues(const ObjList& list, const std::vector<int32_t>& entries, size_t which,
               const Connectivity& connectivity)
      : list_(list), entries_(entries), which_(which), connectivity_(connectivity) {}

  void add_to(uint64_t unreadable, MeshFrame& out) {
    find_faces(unreadable, out);
    if (without_ == none_.size()) {  // none has them at all its corners
      out.unkept.push_back({std::string(kListWords[which_]) + " of no corner", list_.size()});
      return;
    }
    const uint32_t channels = which_ == 0 ? std::max(list_.channels, 1u) : 3;
    std::vector<float> values(entries_.size() * channels);
    std::vector<uint8_t> used(list_.size());
    size_t corner = 0;
    for (size_t f = 0; f < none_.size(); ++f) {
      for (uint32_t i = 0; i < connectivity_.face_sizes[f]; ++i, ++corner) {
        if (none_[f] != 0) continue;
        const auto entry = static_cast<size_t>(entries_[corner]);
        used[entry] = 1;
        std::copy_n(&list_.values[3 * entry], channels, &values[corner * channels]);
      }
    }
    if (const auto spare = std::count(used.begin(), used.end(), 0); spare > 0)
      out.unkept.push_back(
          {std::string(kListWords[which_]) + " of no corner", static_cast<uint64_t>(spare)});
    const std::string name = kListNames[which_];
    out.attributes.push_back(
        make_attribute(name, which_ == 0 ? Semantic::kTextureCoordinate : Semantic::kNormal,
                       Domain::kCorner, ValueType::kBinary32, channels, values));
    if (without_ > 0)
      out.attributes.push_back(make_attribute(name + ".none", Semantic::kGroup, Domain::kFace,
                                              ValueType::kU8, 1, none_));
  }

  bool any() const {
    const auto size = static_cast<int64_t>(list_.size());
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](int32_t e) { return e >= 0 && e < size; });
  }

 private:
  // A face has values at all its corners, or is one of those without.
  void find_faces(uint64_t missing, MeshFrame& out) {
    const auto size = static_cast<int64_t>(list_.size());
    uint64_t partly = 0;
    size_t corner = 0;
    for (const uint32_t corners : connectivity_.face_sizes) {
      uint32_t present = 0;
      for (uint32_t i = 0; i < corners; ++i, ++corner) {
        const int32_t entry = entries_[corner];
        if (entry >= size) ++missing;
        if (entry >= 0 && entry < size) ++present;
      }
      none_.push_back(present == corners ? 0 : 1);
      if (present < corners) ++without_;
      if (present > 0 && present < corners) partly += present;
    }
    if (missing > 0)
      out.unkept.push_back(
          {std::string(kListWords[which_]) + " that the file does not have", missing});
    if (partly > 0)
      out.unkept.push_back(
          {std::string(kListWords[which_]) + " of faces that have them at some corners only",
           partly});
  }

  const ObjList& list_;
  const std::vector<int32_t>& entries_;
  size_t which_;
  const Connectivity& connectivity_;
  std::vector<uint8_t> none_;  ///< faces without
  size_t without_ = 0;
};

void add_list(const ObjList& list, const ObjFaces& faces, size_t which,
              const Connectivity& connectivity, MeshFrame& out) {
  const std::string what = kListWords[which];
  CornerValues corners(list, faces.entries[which], which, connectivity);
  if (corners.any())
    corners.add_to(faces.unreadable[which], out);
  else if (list.size() > 0)
    out.unkept.push_back({what + " of no corner", list.size()});
  if (list.not_finite > 0)
    out.notes.push_back(counted(list.not_finite, "entry") + " of the " + what +
                        " not finite, taken as 0");
  if (list.beyond > 0) out.unkept.push_back({"further numbers of " + what, list.beyond});
}

void add_smoothing(const ObjFaces& faces, size_t count, MeshFrame& out) {
  if (!faces.smoothing.used()) return;
  std::vector<int32_t> numbers;
  for (const std::string& name : faces.smoothing.names()) {
    int32_t number = name == "on" ? 1 : 0;
    std::from_chars(name.data(), name.data() + name.size(), number);
    numbers.push_back(number);
  }
  std::vector<int32_t> values = faces.smoothing.of_faces(count);
  for (int32_t& v : values) v = v < 0 ? 0 : numbers[static_cast<size_t>(v)];
  out.attributes.push_back(
      make_attribute("s", Semantic::kGroup, Domain::kFace, ValueType::kI32, 1, values));
}

void add_libraries(std::vector<std::string> libraries, MeshFrame& out) {
  if (libraries.empty()) return;
  std::string all;
  for (const std::string& name : as_utf8(std::move(libraries), out))
    all += (all.empty() ? "" : "\n") + name;
  Attribute a = make_attribute("mtllib", Semantic::kGroup, Domain::kShot, ValueType::kI32, 1,
                               std::vector<int32_t>{0});
  a.names = {all};
  out.attributes.push_back(std::move(a));
}

}  // namespace

int32_t ObjNames::index_of(const std::string& name) {
  const auto [at, added] = index_.emplace(name, static_cast<int32_t>(names_.size()));
  if (added) names_.push_back(name);
  return at->second;
}

std::vector<int32_t> ObjNames::of_faces(size_t count) const {
  std::vector<int32_t> out(count, kNone);
  for (size_t i = 0; i < changes_.size(); ++i) {
    const size_t end = i + 1 < changes_.size() ? changes_[i + 1].first : count;
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(changes_[i].first),
              out.begin() + static_cast<std::ptrdiff_t>(end), changes_[i].second);
  }
  return out;
}

void ObjFaces::begin(const std::array<ObjList, 2>& lists) {
  for (size_t k = 0; k < names.size(); ++k) names_before[k] = names[k].name();
  names_before[3] = smoothing.name();
  entries_before = {lists[0].size(), lists[1].size()};
}

void ObjFaces::set_entry(size_t list, size_t corner, int32_t entry) {
  if (entry == ObjList::kNone && entries[list].empty()) return;
  entries[list].resize(corner, ObjList::kNone);
  entries[list].push_back(entry);
}

void add_obj_attributes(const std::array<ObjList, 2>& lists, const ObjFaces& faces,
                        const std::vector<std::string>& libraries, const Connectivity& connectivity,
                        MeshFrame& out) {
  const size_t count = connectivity.face_sizes.size();
  for (size_t which = 0; which < 2; ++which)
    add_list(lists[which], faces, which, connectivity, out);
  for (size_t k = 0; k < faces.names.size(); ++k) {
    const ObjNames& names = faces.names[k];
    if (names.unused() > 0)
      out.unkept.push_back({std::string(kNameWords[k]) + " without faces", names.unused()});
    if (!names.used()) continue;
    Attribute a = make_attribute(kNameStatements[k],
                                 k == ObjFaces::kMaterial ? Semantic::kMaterial : Semantic::kGroup,
                                 Domain::kFace, ValueType::kI32, 1, names.of_faces(count));
    a.names = as_utf8(names.names(), out);
    out.attributes.push_back(std::move(a));
  }
  add_smoothing(faces, count, out);
  std::vector<std::string> all = libraries;
  all.insert(all.end(), faces.libraries.begin(), faces.libraries.end());
  add_libraries(std::move(all), out);
}

namespace {

/// For each corner, whether its face has values.
std::vector<bool> present_corners(const Attribute* none, const Connectivity& connectivity) {
  std::vector<bool> out;
  for (size_t f = 0; f < connectivity.face_sizes.size(); ++f)
    out.insert(out.end(), connectivity.face_sizes[f], none == nullptr || none->values[f] == 0);
  return out;
}

}  // namespace

void add_list_order(const ObjFaces& faces, const Connectivity& connectivity,
                    std::vector<Attribute>& out) {
  for (size_t which = 0; which < 2; ++which) {
    const std::string name = kListNames[which];
    if (attribute_named(out, name) == nullptr) continue;
    const std::vector<bool> present =
        present_corners(attribute_named(out, name + ".none"), connectivity);
    const std::vector<int32_t>& entries = faces.entries[which];
    std::vector<int32_t> rank;
    for (size_t c = 0; c < entries.size(); ++c) {
      if (present[c]) rank.push_back(entries[c]);
    }
    std::sort(rank.begin(), rank.end());
    rank.erase(std::unique(rank.begin(), rank.end()), rank.end());
    std::vector<int32_t> index(entries.size(), ObjList::kNone);
    for (size_t c = 0; c < index.size(); ++c) {
      const auto at = std::lower_bound(rank.begin(), rank.end(), entries[c]);
      if (present[c]) index[c] = static_cast<int32_t>(at - rank.begin());
    }
    out.push_back(make_attribute(name + ".index", Semantic::kIndex, Domain::kCorner,
                                 ValueType::kI32, 1, index));
  }
}

ListOrder plain_order(const uint8_t* values, size_t corners, size_t bytes) {
  ListOrder out;
  std::unordered_map<std::string_view, uint32_t> entries;
  for (size_t c = 0; c < corners; ++c) {
    const std::string_view key(reinterpret_cast<const char*>(values + c * bytes), bytes);
    const auto [at, added] =
        entries.emplace(key, static_cast<uint32_t>(out.corner_of_entry.size()));
    if (added) out.corner_of_entry.push_back(static_cast<uint32_t>(c));
    out.entry_of_corner.push_back(at->second);
  }
  return out;
}

void drop_plain_orders(Shot& shot) {
  const size_t corners = shot.connectivity.corners.size();
  const auto is_plain = [&](const Attribute& list, const Attribute& index) {
    for (uint32_t t = 0; t < shot.frame_count; ++t) {
      const size_t frame = list.animated ? t : 0, order = index.animated ? t : 0;
      const ListOrder plain = plain_order(&list.values[frame * corners * list.element_bytes()],
                                          corners, list.element_bytes());
      if (std::memcmp(plain.entry_of_corner.data(), &index.values[order * corners * 4],
                      corners * 4) != 0)
        return false;
      if (!list.animated && !index.animated) break;
    }
    return true;
  };
  std::erase_if(shot.attributes, [&](const Attribute& index) {
    if (index.semantic != Semantic::kIndex) return false;
    const Attribute* list = find_attribute(
        shot.attributes, [&](const Attribute& a) { return a.name + ".index" == index.name; });
    return list != nullptr && is_plain(*list, index);
  });
}

}  // namespace reeb::tools
