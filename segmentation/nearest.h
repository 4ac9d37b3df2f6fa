// Nearest neighbour among points in space.
#pragma once

#include <cstdint>
#include <vector>

#include "segmentation/surface.h"

namespace reeb::segmentation {

/// A balanced k-d tree over points that stay where they are.
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<Point> points);

  /// Index of the point nearest to `query`; there must be at least one point.
  uint32_t find(const Point& query) const;

 private:
  void sort(size_t begin, size_t end, int axis);
  void search(size_t begin, size_t end, int axis, const Point& query, size_t& best,
              double& best_distance) const;

  std::vector<Point> points_;
  std::vector<uint32_t> order_;  // the median of a range splits it
};

}  // namespace reeb::segmentation
