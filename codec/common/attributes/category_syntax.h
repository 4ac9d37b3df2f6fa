// Syntax of integers that name something: materials and groups, face after face in output order;
// places in a list of the source, corner after corner.
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
  /// Of faces or, `of_corners`, of corners.
  CategorySyntax(const FaceCorners& corners, bool of_corners, uint32_t top)
      : corners_(corners), of_corners_(of_corners), top_(top) {}

  /// Codes one value per element, each 0 .. top: complete with encoders, filled in with decoders.
  template <class Coder>
  Status code(Coder& coder, std::vector<uint32_t>& values) {
    const auto faces = static_cast<uint32_t>(corners_.first.size() - 1);
    const uint32_t count = of_corners_ ? corners_.count() : faces;
    values.resize(count);
    for (uint32_t e = 0; e < count; ++e) {
      values[e] = code_element(coder, e, values);
      if (!of_corners_) recent_.use(values[e]);
      if (ran_dry(coder)) return Status::corrupt("the values of an attribute are cut off");
      if (values[e] > top_) return Status::corrupt("an attribute's value is out of range");
    }
    return {};
  }

 private:
  /// Of the elements next to one, those before it in order.
  struct Around {
    uint32_t same = 0;   ///< with the value of the element before
    uint32_t other = 0;  ///< with another
    uint32_t value = 0;  ///< the first such
  };

  /// Calls visit(e) for the faces across the edges of a face, or for the corners that joints
  /// connect with a corner: across the edge from it, then across the edge to it.
  template <class Visit>
  void for_each_near(uint32_t element, Visit visit) const {
    const auto& twin = corners_.twin;
    if (of_corners_) {
      if (twin[element] != kNoTwin) visit(corners_.next(twin[element]));
      const uint32_t into = twin[corners_.previous(element)];
      if (into != kNoTwin) visit(into);
      return;
    }
    for (uint32_t c = corners_.first[element]; c < corners_.first[element + 1]; ++c) {
      if (twin[c] != kNoTwin) visit(corners_.face[twin[c]]);
    }
  }

  Around look_around(uint32_t element, uint32_t before, const std::vector<uint32_t>& values) const {
    Around out;
    for_each_near(element, [&](uint32_t near) {
      if (near >= element) return;
      if (values[near] == before) {
        ++out.same;
      } else if (out.other++ == 0) {
        out.value = values[near];
      }
    });
    return out;
  }

  template <class Coder>
  uint32_t code_element(Coder& coder, uint32_t element, const std::vector<uint32_t>& values) {
    const uint32_t value = values[element];
    if (element == 0) return code_new(coder, value);
    const uint32_t before = values[element - 1];
    const Around around = look_around(element, before, values);
    const uint32_t same = std::min(around.same, 2u), other = std::min(around.other, 2u);
    last_ = !same_[same][other][last_ ? 1 : 0].code(coder, value == before);
    if (!last_) return before;
    if (other > 0 && across_[same].code(coder, value == around.value)) return around.value;
    if (of_corners_) return code_new(coder, value);
    const uint32_t rank = rank_.code(coder, recent_.rank(value));
    return rank < recent_.count() ? recent_[rank] : code_new(coder, value);
  }

  // Relative to the one before or, as lists are numbered in the order of corners, to the highest.
  template <class Coder>
  uint32_t code_new(Coder& coder, uint32_t value) {
    const auto gap = static_cast<int64_t>(value) - newest_;
    const int64_t coded = newest_ + new_.code(coder, static_cast<int32_t>(gap));
    const int64_t clamped = std::clamp<int64_t>(coded, 0, int64_t{top_} + 1);
    newest_ = of_corners_ ? std::max(newest_, clamped) : clamped;
    return static_cast<uint32_t>(clamped);
  }

  const FaceCorners& corners_;
  const bool of_corners_;
  const uint32_t top_;
  RecentValues recent_;
  bool last_ = false;  ///< the element before differs from the one before it
  int64_t newest_ = -1;
  std::array<std::array<std::array<AdaptiveBit, 2>, 3>, 3> same_;
  std::array<AdaptiveBit, 3> across_;
  ExpGolombModel rank_;
  SignedModel new_;
};

}  // namespace reeb
