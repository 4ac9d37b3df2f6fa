#include "codec/dec/connectivity/surface_builder.h"

#include <numeric>
#include <utility>

namespace reeb {
namespace {

uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
uint32_t last(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

}  // namespace

SurfaceBuilder::SurfaceBuilder(uint32_t triangle_count, uint32_t point_count)
    : opposite_(size_t{3} * triangle_count, kNone),
      point_(size_t{3} * triangle_count),
      outer_(point_count),
      became_(point_count),
      degree_(point_count) {
  std::iota(became_.begin(), became_.end(), 0u);
}

// Paths are halved on the way, so that however points become others, this takes few steps.
uint32_t SurfaceBuilder::point(uint32_t corner) {
  uint32_t p = point_[corner];
  while (became_[p] != p) p = became_[p] = became_[became_[p]];
  return p;
}

uint32_t SurfaceBuilder::start(uint32_t edge) { return point(next(edge)); }
uint32_t SurfaceBuilder::end(uint32_t edge) { return point(last(edge)); }

/// The edge at the other end of the fan around the start of free edge a.
uint32_t SurfaceBuilder::following(uint32_t a) { return next(outer_[start(a)]); }

bool SurfaceBuilder::has_room(uint32_t new_points) const {
  return triangles_ < point_.size() / 3 && new_points <= outer_.size() - points_;
}

uint32_t SurfaceBuilder::new_triangle(uint32_t p0, uint32_t p1, uint32_t p2) {
  const uint32_t corner = 3 * triangles_++;
  point_[corner] = p0;
  point_[corner + 1] = p1;
  point_[corner + 2] = p2;
  return corner;
}

uint32_t SurfaceBuilder::new_point(uint32_t outer) {
  outer_[points_] = outer;
  degree_[points_] = 2;
  return points_++;
}

void SurfaceBuilder::glue(uint32_t a, uint32_t b) {
  opposite_[a] = b;
  opposite_[b] = a;
}

uint32_t SurfaceBuilder::add_alone() {
  if (!has_room(3)) return kNone;
  const uint32_t corner = 3 * triangles_;
  const uint32_t p = new_point(corner);
  new_point(corner + 1);
  new_point(corner + 2);
  return new_triangle(p, p + 1, p + 2);
}

uint32_t SurfaceBuilder::add_across(uint32_t a, bool right) {
  if (!has_room(1) || !is_free(a)) return kNone;
  const uint32_t from = start(a), to = end(a);
  const uint32_t corner = 3 * triangles_;
  const uint32_t tip = right ? corner + 2 : corner + 1;
  const uint32_t p = new_point(tip);
  outer_[to] = right ? corner : corner + 2;
  ++degree_[from];
  ++degree_[to];
  if (right)
    new_triangle(to, from, p);
  else
    new_triangle(from, p, to);
  glue(a, tip);
  return corner;
}

uint32_t SurfaceBuilder::add_left(uint32_t a) { return add_across(a, false); }
uint32_t SurfaceBuilder::add_right(uint32_t a) { return add_across(a, true); }

uint32_t SurfaceBuilder::add_closing(uint32_t a) {
  if (!has_room(0) || !is_free(a)) return kNone;
  const uint32_t b = following(a);
  if (a == b || !is_free(b)) return kNone;
  const uint32_t from = start(b), to = end(a);
  const uint32_t corner = new_triangle(start(a), from, to);
  outer_[to] = corner + 2;
  ++degree_[from];
  ++degree_[to];
  glue(a, corner + 1);
  glue(b, corner + 2);
  return corner;
}

uint32_t SurfaceBuilder::add_joining(uint32_t a, uint32_t b) {
  if (!has_room(0) || a == b || !is_free(a) || !is_free(b)) return kNone;
  const uint32_t kept = end(a), gone = start(b);
  if (kept == gone) return kNone;
  const uint32_t from = start(a), to = end(b);
  const uint32_t corner = new_triangle(kept, from, to);
  outer_[to] = corner + 2;
  outer_[kept] = outer_[gone];
  degree_[kept] += degree_[gone];
  became_[gone] = kept;
  joined_.push_back(gone);
  ++degree_[point(corner + 1)];
  ++degree_[point(corner + 2)];
  glue(a, corner + 2);
  glue(b, corner + 1);
  return corner;
}

uint32_t SurfaceBuilder::add_last(uint32_t a) {
  if (!has_room(0) || !is_free(a)) return kNone;
  const uint32_t b = following(a);
  if (!is_free(b)) return kNone;
  const uint32_t c = following(b);
  if (!is_free(c) || a == b || b == c || c == a || start(c) != end(a)) return kNone;
  const uint32_t corner = new_triangle(start(b), start(c), start(a));
  glue(a, corner);
  glue(b, corner + 1);
  glue(c, corner + 2);
  return corner;
}

// Each number that became free takes the last point, in the order in which they became free.
std::vector<uint32_t> SurfaceBuilder::number_points() const {
  std::vector<uint32_t> holder(points_);  // the point that has each number
  std::iota(holder.begin(), holder.end(), 0u);
  for (const uint32_t p : joined_) holder[p] = kNone;
  uint32_t count = points_;
  for (const uint32_t number : joined_) {
    while (holder[count - 1] == kNone) --count;
    if (number >= count) continue;
    holder[number] = std::exchange(holder[count - 1], kNone);
  }
  std::vector<uint32_t> number_of(points_);
  for (uint32_t i = 0; i < points_; ++i) {
    if (holder[i] != kNone) number_of[holder[i]] = i;
  }
  return number_of;
}

std::vector<uint32_t> SurfaceBuilder::take_triangles() {
  for (uint32_t c = 0; c < point_.size(); ++c) point_[c] = point(c);
  if (!joined_.empty()) {
    const std::vector<uint32_t> number_of = number_points();
    for (uint32_t& p : point_) p = number_of[p];
  }
  return std::move(point_);
}

}  // namespace reeb
