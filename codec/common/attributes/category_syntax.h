// Syntax of integers that name something - materials, groups - face after face in output order.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/attributes/face_corners.h"
#include "codec/common/reference/mesh_state.h"
#include "entropy/integer_coder.h"

namespace reeb {

/// Values that occurred, the latest first.
class RecentValues {
 public:
  /// `rank` of `value`; how many there are where it is new.
  uint32_t rank(uint32_t value) const {
    return static_cast<uint32_t>(std::find(values_.begin(), values_.end(), value) -
                                 values_.begin());
  }
  uint32_t count() const { return static_cast<uint32_t>(values_.size()); }
  uint32_t operator[](uint32_t rank) const { return values_[rank]; }
  void use(uint32_t value) {
    const auto at = std::find(values_.begin(), values_.end(), value);
    if (at != values_.end()) {
      std::rotate(values_.begin(), at, at + 1);
    } else if (values_.size() == kMaxValues) {
      std::rotate(values_.begin(), values_.end() - 1, values_.end());
      values_[0] = value;
    } else {
      values_.insert(values_.begin(), value);
    }
  }

 private:
  static constexpr size_t kMaxValues = 256;
  std::vector<uint32_t> values_;
};

class CategorySyntax {
 public:
  CategorySyntax(const FaceCorners& corners, uint32_t top) : corners_(corners), top_(top) {}

  /// Codes one value per face, each 0 .. top: complete with encoders, filled in with decoders.
  template <class Coder>
  Status code(Coder& coder, std::vector<uint32_t>& values) {
    const auto count = static_cast<uint32_t>(corners_.first.size() - 1);
    values.resize(count);
    for (uint32_t face = 0; face < count; ++face) {
      values[face] = code_face(coder, face, values);
      recent_.use(values[face]);
      if (ran_dry(coder)) return Status::corrupt("the values of an attribute are cut off");
      if (values[face] > top_) return Status::corrupt("an attribute's value is out of range");
    }
    return {};
  }

 private:
  /// Of the faces across the edges of a face, those before it in order.
  struct Around {
    uint32_t same = 0;   ///< with the value of the face before
    uint32_t other = 0;  ///< with another
    uint32_t value = 0;  ///< the first such
  };

  Around look_around(uint32_t face, uint32_t before, const std::vector<uint32_t>& values) const {
    Around out;
    for (uint32_t c = corners_.first[face]; c < corners_.first[face + 1]; ++c) {
      if (corners_.twin[c] == kNoTwin) continue;
      const uint32_t across = corners_.face[corners_.twin[c]];
      if (across >= face) continue;
      if (values[across] == before) {
        ++out.same;
      } else if (out.other++ == 0) {
        out.value = values[across];
      }
    }
    return out;
  }

  template <class Coder>
  uint32_t code_face(Coder& coder, uint32_t face, const std::vector<uint32_t>& values) {
    const uint32_t value = values[face];
    if (face == 0) return code_new(coder, value);
    const uint32_t before = values[face - 1];
    const Around around = look_around(face, before, values);
    const uint32_t same = std::min(around.same, 2u), other = std::min(around.other, 2u);
    last_ = !same_[same][other][last_ ? 1 : 0].code(coder, value == before);
    if (!last_) return before;
    if (other > 0 && across_[same].code(coder, value == around.value)) return around.value;
    const uint32_t rank = rank_.code(coder, recent_.rank(value));
    return rank < recent_.count() ? recent_[rank] : code_new(coder, value);
  }

  template <class Coder>
  uint32_t code_new(Coder& coder, uint32_t value) {
    const auto gap = static_cast<int64_t>(value) - newest_;
    newest_ += new_.code(coder, static_cast<int32_t>(gap));
    newest_ = std::clamp<int64_t>(newest_, 0, int64_t{top_} + 1);
    return static_cast<uint32_t>(newest_);
  }

  const FaceCorners& corners_;
  const uint32_t top_;
  RecentValues recent_;
  bool last_ = false;  ///< the face before differs from the one before it
  int64_t newest_ = -1;
  std::array<std::array<std::array<AdaptiveBit, 2>, 3>, 3> same_;
  std::array<AdaptiveBit, 3> across_;
  ExpGolombModel rank_;
  SignedModel new_;
};

}  // namespace reeb
