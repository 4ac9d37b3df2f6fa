#include "segmentation/nearest.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace reeb::segmentation {

NearestPoint::NearestPoint(std::vector<Point> points)
    : points_(std::move(points)), order_(points_.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  sort(0, order_.size(), 0);
}

void NearestPoint::sort(size_t begin, size_t end, int axis) {
  if (end - begin < 2) return;
  const size_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](uint32_t a, uint32_t b) {
                     const double pa = points_[a][axis], pb = points_[b][axis];
                     return pa != pb ? pa < pb : a < b;
                   });
  sort(begin, middle, (axis + 1) % 3);
  sort(middle + 1, end, (axis + 1) % 3);
}

uint32_t NearestPoint::find(const Point& query) const {
  size_t best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  search(0, order_.size(), 0, query, best, best_distance);
  return order_[best];
}

void NearestPoint::search(size_t begin, size_t end, int axis, const Point& query, size_t& best,
                          double& best_distance) const {
  if (begin >= end) return;
  const size_t middle = begin + (end - begin) / 2;
  const Point& pivot = points_[order_[middle]];
  const double distance = (pivot - query).squaredNorm();
  if (distance < best_distance) {
    best_distance = distance;
    best = middle;
  }
  const double offset = query[axis] - pivot[axis];
  const int next = (axis + 1) % 3;
  const bool below = offset < 0;
  const std::pair near_side = below ? std::pair(begin, middle) : std::pair(middle + 1, end);
  const std::pair far_side = below ? std::pair(middle + 1, end) : std::pair(begin, middle);
  search(near_side.first, near_side.second, next, query, best, best_distance);
  if (offset * offset < best_distance) {
    search(far_side.first, far_side.second, next, query, best, best_distance);
  }
}

}  // namespace reeb::segmentation
