// Syntax of the motion section, one function for writing and reading.
#pragma once

#include <algorithm>

#include "codec/common/motion/motion_model.h"

namespace reeb {

/// Codes one region index among those its ring suggests, most frequent first, or outright.
class RegionIndexModel {
 public:
  template <class Coder>
  uint32_t code(Coder& coder, const std::vector<uint32_t>& suggestions, uint32_t region) {
    const size_t known = std::min<size_t>(suggestions.size(), kSuggestions);
    for (size_t i = 0; i < known; ++i) {
      if (hit_[known][i].code(coder, suggestions[i] == region)) return suggestions[i];
    }
    return outright_.code(coder, region);
  }

 private:
  static constexpr size_t kSuggestions = 3;
  std::array<std::array<AdaptiveBit, kSuggestions>, kSuggestions + 1> hit_;
  ExpGolombModel outright_;
};

class BindingCoder {
 public:
  BindingCoder(const PredictionGraph& graph, std::vector<RegionBinding>& bindings)
      : graph_(graph), bindings_(bindings) {}

  /// Codes the binding of a row, all earlier ones being known.
  template <class Coder>
  void code(Coder& coder, uint32_t row) {
    RegionBinding& b = bindings_[row];
    const std::vector<uint32_t> near = regions_around(row, UINT32_MAX);
    b.primary = primary_.code(coder, near, b.primary);
    const uint32_t context =
        std::min<uint32_t>(static_cast<uint32_t>(near.size()), 3) * 2 + blended_around(row);
    if (!blended_[context].code(coder, b.weight > 0)) {
      b.secondary = b.weight = 0;
      return;
    }
    b.secondary = secondary_.code(coder, regions_around(row, b.primary), b.secondary);
    uint32_t node = 1;
    for (int bit = 2; bit >= 0; --bit) {
      node = node * 2 + (weight_[node].code(coder, ((b.weight - 1) >> bit & 1) != 0) ? 1 : 0);
    }
    b.weight = node - RegionBinding::kMaxWeight + 1;
  }

 private:
  /// Regions of the ring, most frequent first, ties by which reached the count first; without
  /// `except`.
  std::vector<uint32_t> regions_around(uint32_t row, uint32_t except) const;
  uint32_t blended_around(uint32_t row) const;

  const PredictionGraph& graph_;
  std::vector<RegionBinding>& bindings_;
  RegionIndexModel primary_;
  RegionIndexModel secondary_;
  std::array<AdaptiveBit, 8> blended_;
  std::array<AdaptiveBit, 8> weight_;
};

/// Codes the transforms of one component after another.
class TransformCoder {
 public:
  template <class Coder>
  void code(Coder& coder, std::vector<MotionModel::Transform>& transforms) {
    const bool any = std::any_of(transforms.begin(), transforms.end(),
                                 [](const auto& t) { return t != MotionModel::Transform{}; });
    if (!used_.code(coder, any, 30)) {
      std::fill(transforms.begin(), transforms.end(), MotionModel::Transform{});
      return;
    }
    uint32_t scale = 0;  // bit length of the magnitudes coded just before
    for (MotionModel::Transform& t : transforms) {
      for (uint32_t i = 0; i < MotionModel::kParameters; ++i) {
        t[i] = entry_[i == 3][std::min(scale, kScales - 1)].code(coder, t[i]);
        const auto magnitude = static_cast<uint32_t>(t[i] < 0 ? -t[i] : t[i]);
        scale = (scale + static_cast<uint32_t>(std::bit_width(magnitude)) + 1) / 2;
      }
    }
  }

 private:
  static constexpr uint32_t kScales = 16;
  AdaptiveBit used_;
  std::array<std::array<SignedModel, kScales>, 2> entry_;
};

/// a + sign * b, entry by entry, modulo 2^32: damaged streams may hold anything.
inline void add_transforms(std::vector<MotionModel::Transform>& a,
                           const std::vector<MotionModel::Transform>& b, uint32_t sign) {
  for (size_t region = 0; region < a.size(); ++region) {
    for (uint32_t i = 0; i < MotionModel::kParameters; ++i) {
      const auto sum =
          static_cast<uint32_t>(a[region][i]) + sign * static_cast<uint32_t>(b[region][i]);
      a[region][i] = static_cast<int32_t>(sum);
    }
  }
}

template <class Coder>
bool MotionModel::code(Coder& coder, const PredictionGraph& graph, uint32_t stride) {
  bindings_.resize(graph.size());
  BindingCoder binding_coder(graph, bindings_);
  for (uint32_t row = 0; row < graph.size(); ++row) {
    binding_coder.code(coder, row);
    if (bindings_[row].primary >= regions_ || bindings_[row].secondary >= regions_) return false;
  }
  TransformCoder transform_coder;
  for (size_t k = 0; k < transforms_.size(); ++k) {
    transforms_[k].resize(regions_);
    const bool follows = stride > 0 && k >= stride;
    if (follows) add_transforms(transforms_[k], transforms_[k - stride], UINT32_MAX);  // times -1
    transform_coder.code(coder, transforms_[k]);
    if (follows) add_transforms(transforms_[k], transforms_[k - stride], 1);
    if constexpr (requires { coder.overrun(); }) {
      if (coder.overrun()) return false;  // before more is allocated than the bytes can mean
    }
  }
  return true;
}

}  // namespace reeb
