// What an OBJ says of its faces and their corners beside the vertices, and how that becomes
// attributes.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

struct MeshFrame;

/// Names that a kind of statement gives to the faces that follow it.
class ObjNames {
 public:
  static constexpr int32_t kNone = -1;
  static constexpr std::string_view kDefault = "default";  ///< which exporters write unasked

  void set(std::string_view name) {
    if (name == name_) return;
    unused_ = unused();
    name_ = name;
    pending_ = true;
  }
  /// Face number `face` begins.
  void take(size_t face) {
    if (!pending_) return;
    pending_ = false;
    const int32_t index = name_.empty() ? kNone : index_of(name_);
    if (changes_.empty() ? index != kNone : index != changes_.back().second)
      changes_.emplace_back(face, index);
  }
  bool used() const { return !changes_.empty(); }
  const std::string& name() const { return name_; }
  const std::vector<std::string>& names() const { return names_; }
  /// Names that no face has.
  uint64_t unused() const {
    return unused_ + (pending_ && !name_.empty() && name_ != kDefault ? 1 : 0);
  }
  std::vector<int32_t> of_faces(size_t count) const;

 private:
  int32_t index_of(const std::string& name);

  std::string name_;
  bool pending_ = false;
  uint64_t unused_ = 0;
  std::vector<std::string> names_;  ///< in the order of their first faces
  std::map<std::string, int32_t> index_;
  std::vector<std::pair<size_t, int32_t>> changes_;  ///< (first face, name)
};

/// A list of OBJ that corners point into: `vt` or `vn`.
struct ObjList {
  static constexpr int32_t kNone = -1;

  std::vector<float> values;  ///< three to an entry
  uint32_t channels = 0;      ///< of the entry with the most
  uint64_t not_finite = 0;    ///< entries that are no numbers; they are 0
  uint64_t beyond = 0;        ///< numbers past the last channel

  size_t size() const { return values.size() / 3; }
};

/// What the text from the first face on says, but for the vertices.
struct ObjFaces {
  enum Kind { kMaterial, kGroup, kObject };
  std::array<ObjNames, 3> names;
  ObjNames smoothing;                           ///< numbers as text
  std::array<std::vector<int32_t>, 2> entries;  ///< of `vt` and `vn`, for each corner; or empty
  std::array<uint64_t, 2> unreadable{};         ///< corners with an entry that cannot be
  std::vector<std::string> libraries;           ///< `mtllib`
  // As it stood before the first face.
  std::array<std::string, 4> names_before;
  std::array<size_t, 2> entries_before{};

  /// At the first face.
  void begin(const std::array<ObjList, 2>& lists);
  bool begins_like(const ObjFaces& other) const {
    return names_before == other.names_before && entries_before == other.entries_before;
  }
  /// Sets the entry of corner `corner`, the last.
  void set_entry(size_t list, size_t corner, int32_t entry);
};

/// Adds the attributes, and what is odd about them, to a frame. `libraries`: those before the first
/// face.
void add_obj_attributes(const std::array<ObjList, 2>& lists, const ObjFaces& faces,
                        const std::vector<std::string>& libraries, const Connectivity& connectivity,
                        MeshFrame& out);

/// The order of the lists as attributes `vt.index` and `vn.index`: the place of each corner's entry
/// among those that corners have.
void add_list_order(const ObjFaces& faces, const Connectivity& connectivity,
                    std::vector<Attribute>& out);

/// Removes those that say what the values do themselves.
void drop_plain_orders(Shot& shot);

/// Entries of a list, each told by a corner that has it, and the entry of each corner.
struct ListOrder {
  std::vector<uint32_t> corner_of_entry;
  std::vector<uint32_t> entry_of_corner;
};

/// Equal values are one entry, in the order of the first corners. `values`: `bytes` for each.
ListOrder plain_order(const uint8_t* values, size_t corners, size_t bytes);

}  // namespace reeb::tools
