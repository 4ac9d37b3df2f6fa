// A surface that grows triangle by triangle along its free edges, as the symbols of an edgebreaker
// say, the last triangle of its encoder first.
//
// Corner 3t+i is corner i of triangle t; an edge is named by the corner opposite to it in its
// triangle. Around every point there is one fan of triangles, closed or between two free edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace reeb {

class SurfaceBuilder {
 public:
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  /// Nothing yet of a surface of `triangle_count` triangles, for which `point_count` points are
  /// made in all.
  SurfaceBuilder(uint32_t triangle_count, uint32_t point_count);

  // Each adds a triangle and gives the corner opposite to the edge that is active now, its first
  // one; kNone where there is no room or an edge that should be free is not.

  /// Three new points.
  uint32_t add_alone();
  /// A new point across edge a; the edge to the right of it is active, or that to the left.
  uint32_t add_left(uint32_t a);
  uint32_t add_right(uint32_t a);
  /// Between edge a and the free edge that follows it; their common point is inside from now on.
  uint32_t add_closing(uint32_t a);
  /// Between edges a and b; the end of a and the start of b become one point.
  uint32_t add_joining(uint32_t a, uint32_t b);
  /// Into a hole of three free edges, one of which is a. Nothing is active behind it.
  uint32_t add_last(uint32_t a);

  bool is_free(uint32_t edge) const { return opposite_[edge] == kNone; }
  /// Edges of the point that an edge starts at.
  uint32_t degree_at_start(uint32_t edge) { return degree_[start(edge)]; }

  uint32_t triangle_count() const { return triangles_; }
  uint32_t point_count() const { return points_ - static_cast<uint32_t>(joined_.size()); }
  uint32_t joined_count() const { return static_cast<uint32_t>(joined_.size()); }

  /// The points of all corners. Numbers of points that became others are given to the last ones, so
  /// that none is missing. Ends the building.
  std::vector<uint32_t> take_triangles();

 private:
  uint32_t point(uint32_t corner);
  uint32_t start(uint32_t edge);
  uint32_t end(uint32_t edge);
  uint32_t following(uint32_t a);
  bool has_room(uint32_t new_points) const;
  uint32_t new_triangle(uint32_t p0, uint32_t p1, uint32_t p2);
  uint32_t new_point(uint32_t outer);
  void glue(uint32_t a, uint32_t b);
  uint32_t add_across(uint32_t a, bool right);
  std::vector<uint32_t> number_points() const;

  uint32_t triangles_ = 0, points_ = 0;
  std::vector<uint32_t> opposite_;  ///< the corner across each edge, kNone where the edge is free
  std::vector<uint32_t> point_;     ///< of each corner, as when it was made
  std::vector<uint32_t> outer_;     ///< the corner of each point whose next one is a free edge
  std::vector<uint32_t> became_;    ///< the point that each point became, or itself
  std::vector<uint32_t> degree_;
  std::vector<uint32_t> joined_;  ///< points that became others, in this order
};

}  // namespace reeb
