// How alike two segmentations of the same vertices are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmentation/surface.h"

namespace reeb::benchmark {

/// Rand index: part of the pairs of vertices on which two partitions agree, together or apart; 0
/// .. 1.
double rand_index(std::span<const uint32_t> a, std::span<const uint32_t> b);

/// Tells whether extremities found on different poses of one mesh are the same ones.
class ExtremityMatcher {
 public:
  /// `positions` and `triangles` are those of one pose, on which distances are measured.
  ExtremityMatcher(std::span<const float> positions, std::span<const uint32_t> triangles);

  /// Both sets have the same number of vertices, and each vertex has one of the other set within
  /// `radius` sqrt(area) of its piece along edges.
  bool same(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b, double radius) const;

 private:
  bool covers(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b, double radius) const;

  segmentation::Pieces pieces_;
};

}  // namespace reeb::benchmark
