#include "tools/picture/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace reeb::tools {
namespace {

Vec3 point(std::span<const float> positions, size_t v) {
  return {positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
}

using Face = std::span<const uint32_t>;

std::vector<Face> faces_of(const Connectivity& connectivity) {
  std::vector<Face> faces;
  const uint32_t* corner = connectivity.corners.data();
  for (const uint32_t size : connectivity.face_sizes) {
    faces.emplace_back(corner, size);
    corner += size;
  }
  return faces;
}

/// Normal of a polygon, twice its area long, so that large faces count more in sums.
Vec3 area_normal(Face face, std::span<const float> positions) {
  Vec3 sum;
  for (size_t i = 2; i < face.size(); ++i) {
    const Vec3 a = point(positions, face[0]);
    sum += cross(point(positions, face[i - 1]) - a, point(positions, face[i]) - a);
  }
  return sum;
}

constexpr double kCreaseCosine = 0.77;  ///< faces that meet at more than 40 degrees keep their edge
constexpr size_t kMaxCreased =
    100;  ///< faces around a vertex; where there are more, all are smooth

/// Normals at the corners of faces: of all faces at the vertex that are not across a crease.
class CornerNormals {
 public:
  CornerNormals(const std::vector<Face>& faces, std::span<const float> positions,
                uint32_t vertex_count)
      : sums_(vertex_count), first_(size_t{vertex_count} + 1) {
    for (const Face face : faces) {
      areas_.push_back(area_normal(face, positions));
      for (const uint32_t v : face) {
        ++first_[size_t{v} + 1];
        sums_[v] += areas_.back();
      }
    }
    for (size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    around_.resize(first_.back());
    std::vector<size_t> next(first_.begin(), first_.end() - 1);
    for (size_t i = 0; i < faces.size(); ++i) {
      for (const uint32_t v : faces[i]) around_[next[v]++] = i;
    }
  }

  Vec3 at(size_t face, uint32_t v) const {
    if (first_[size_t{v} + 1] - first_[v] > kMaxCreased) return sums_[v];
    const Vec3 own = normalized(areas_[face]);
    Vec3 sum;
    for (size_t i = first_[v]; i < first_[size_t{v} + 1]; ++i) {
      const Vec3& other = areas_[around_[i]];
      if (dot(own, other) >= kCreaseCosine * length(other)) sum += other;
    }
    return sum;
  }

 private:
  std::vector<Vec3> areas_;     ///< of each face
  std::vector<Vec3> sums_;      ///< of each vertex
  std::vector<size_t> first_;   ///< of each vertex, in `around_`
  std::vector<size_t> around_;  ///< faces at each vertex
};

/// A vertex in the picture.
struct Corner {
  Vec3 at;      ///< pixels right and down, units of the mesh towards the eye
  Vec3 normal;  ///< in the axes of the camera
  Vec3 colour;
  Vec3 place;  ///< in the texture
};

Vec3 blend(const Vec3& a, const Vec3& b, const Vec3& c, const std::array<double, 3>& w) {
  return a * w[0] + b * w[1] + c * w[2];
}

class Rasterizer {
 public:
  /// `texture` may be null.
  Rasterizer(const Image* texture, Image& out)
      : texture_(texture),
        out_(out),
        depth_(out.pixels.size(), -std::numeric_limits<double>::infinity()) {}

  void draw(const Corner& a, const Corner& b, const Corner& c) {
    const double area = edge(a.at, b.at, c.at);
    if (!(std::abs(area) > 1e-12)) return;
    const auto [x_min, x_max] = std::minmax({a.at.x, b.at.x, c.at.x});
    const auto [y_min, y_max] = std::minmax({a.at.y, b.at.y, c.at.y});
    const int left = static_cast<int>(std::clamp(x_min, 0.0, 1.0 * out_.width));
    const int right = static_cast<int>(std::clamp(x_max + 1, 0.0, 1.0 * out_.width));
    const int top = static_cast<int>(std::clamp(y_min, 0.0, 1.0 * out_.height));
    const int bottom = static_cast<int>(std::clamp(y_max + 1, 0.0, 1.0 * out_.height));
    for (int y = top; y < bottom; ++y) {
      const auto weights = [&](double x) {
        const Vec3 p{x + 0.5, y + 0.5, 0};
        return std::array<double, 3>{edge(b.at, c.at, p) / area, edge(c.at, a.at, p) / area,
                                     edge(a.at, b.at, p) / area};
      };
      const auto [first, last] = inside(weights(left), weights(left + 1), right - left);
      for (int x = left + first; x < left + last; ++x) {
        const std::array<double, 3> w = weights(x);
        if (w[0] >= 0 && w[1] >= 0 && w[2] >= 0) draw_pixel(x, y, a, b, c, w);
      }
    }
  }

 private:
  /// The part of 0 .. `count` out of which three linear functions, given at 0 and at 1, are not all
  /// positive, a pixel wider at both ends than rounding needs.
  static std::pair<int, int> inside(const std::array<double, 3>& at_0,
                                    const std::array<double, 3>& at_1, int count) {
    double first = 0;
    double last = count;
    for (size_t i = 0; i < 3; ++i) {
      const double slope = at_1[i] - at_0[i];
      if (slope > 0) first = std::max(first, -at_0[i] / slope - 1);
      if (slope < 0) last = std::min(last, -at_0[i] / slope + 2);
      if (slope == 0 && at_0[i] < 0) last = 0;
    }
    return first < last ? std::pair(static_cast<int>(first), static_cast<int>(last))
                        : std::pair(0, 0);
  }

  static double edge(const Vec3& a, const Vec3& b, const Vec3& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  }

  void draw_pixel(int x, int y, const Corner& a, const Corner& b, const Corner& c,
                  const std::array<double, 3>& w) {
    const double z = w[0] * a.at.z + w[1] * b.at.z + w[2] * c.at.z;
    double& nearest = depth_[static_cast<size_t>(y) * out_.width + x];
    if (z <= nearest) return;
    nearest = z;
    const Vec3 colour = texture_ != nullptr ? texel(blend(a.place, b.place, c.place, w))
                                            : blend(a.colour, b.colour, c.colour, w);
    const double light = shade(normalized(blend(a.normal, b.normal, c.normal, w)));
    const auto channel = [&](double value) {
      return static_cast<uint8_t>(std::clamp(value * light, 0.0, 255.0));
    };
    out_.at(x, y) = {channel(colour.x), channel(colour.y), channel(colour.z)};
  }

  // Between the four nearest pixels.
  Vec3 texel(const Vec3& place) const {
    const auto split = [](double part, int size, int& low, int& high) {
      const double x = (part - std::floor(part)) * size - 0.5;
      const double below = std::floor(x);
      low = (static_cast<int>(below) + size) % size;
      high = (low + 1) % size;
      return x - below;
    };
    int left = 0, right = 0, top = 0, bottom = 0;
    const double x = split(place.x, texture_->width, left, right);
    const double y = split(1 - place.y, texture_->height, top, bottom);
    const auto at = [&](int column, int row) {
      const Colour& c = texture_->at(column, row);
      return Vec3{1.0 * c[0], 1.0 * c[1], 1.0 * c[2]};
    };
    return (at(left, top) * (1 - x) + at(right, top) * x) * (1 - y) +
           (at(left, bottom) * (1 - x) + at(right, bottom) * x) * y;
  }

  // A key light from the upper left, a weak one from the eye, some light from everywhere.
  static double shade(Vec3 normal) {
    if (normal.z < 0) normal = normal * -1;
    const Vec3 key = normalized({-0.5, 0.75, 0.6});
    const double lambert = std::max(0.0, dot(normal, key));
    return 0.32 + 0.58 * lambert + 0.18 * normal.z;
  }

  const Image* texture_;
  Image& out_;
  std::vector<double> depth_;  ///< larger is nearer to the eye
};

}  // namespace

Camera Camera::orbit(double azimuth, double elevation, bool z_up) {
  const double radian = std::acos(-1.0) / 180;
  const double ca = std::cos(azimuth * radian);
  const double sa = std::sin(azimuth * radian);
  const double ce = std::cos(elevation * radian);
  const double se = std::sin(elevation * radian);
  Camera camera{{ca, 0, -sa}, {-sa * se, ce, -ca * se}, {sa * ce, se, ca * ce}};
  if (z_up) {
    for (Vec3* const axis : {&camera.right, &camera.up, &camera.back}) {
      *axis = {axis->x, -axis->z, axis->y};
    }
  }
  return camera;
}

Point Framing::place(const Vec3& p, const Camera& camera, const Image& image) const {
  const Vec3 d = (p - centre) * pixels_per_unit;
  return {0.5 * image.width + dot(d, camera.right), 0.5 * image.height - dot(d, camera.up)};
}

void draw_painted(const Connectivity& connectivity, std::span<const float> positions,
                  const Paint& paint, const Camera& camera, const Framing& framing, Image& out) {
  const std::vector<Face> faces = faces_of(connectivity);
  const CornerNormals normals(faces, positions, connectivity.vertex_count);
  Rasterizer rasterizer(paint.texture, out);
  std::vector<Corner> corners;
  size_t corner = 0;
  for (size_t i = 0; i < faces.size(); ++i) {
    corners.clear();
    for (const uint32_t v : faces[i]) {
      const Vec3 n = normals.at(i, v);
      const Colour& c = paint.corners.size() == 1 ? paint.corners[0] : paint.corners[corner];
      const Point p = framing.place(point(positions, v), camera, out);
      corners.push_back({{p.x, p.y, dot(point(positions, v) - framing.centre, camera.back)},
                         {dot(n, camera.right), dot(n, camera.up), dot(n, camera.back)},
                         {1.0 * c[0], 1.0 * c[1], 1.0 * c[2]},
                         {}});
      if (paint.texture != nullptr) {
        corners.back().place = {paint.texture_coordinates[2 * corner],
                                paint.texture_coordinates[2 * corner + 1], 0};
      }
      ++corner;
    }
    for (size_t k = 2; k < corners.size(); ++k) {
      rasterizer.draw(corners[0], corners[k - 1], corners[k]);
    }
  }
}

void draw_mesh(const Connectivity& connectivity, std::span<const float> positions,
               std::span<const Colour> colours, const Camera& camera, const Framing& framing,
               Image& out) {
  std::vector<Colour> corners;
  if (colours.size() != 1) {
    for (const uint32_t v : connectivity.corners) corners.push_back(colours[v]);
    colours = corners;
  }
  draw_painted(connectivity, positions, {.corners = colours}, camera, framing, out);
}

Vec3 box_centre(std::span<const float> positions) {
  Vec3 low = point(positions, 0);
  Vec3 high = low;
  for (size_t v = 1; v < positions.size() / 3; ++v) {
    const Vec3 p = point(positions, v);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return (low + high) * 0.5;
}

std::array<double, 2> half_extent(std::span<const float> positions, const Camera& camera,
                                  const Vec3& centre) {
  std::array<double, 2> extent{};
  for (size_t v = 0; v < positions.size() / 3; ++v) {
    const Vec3 p = point(positions, v) - centre;
    extent[0] = std::max(extent[0], std::abs(dot(p, camera.right)));
    extent[1] = std::max(extent[1], std::abs(dot(p, camera.up)));
  }
  return extent;
}

Colour error_colour(double value) {
  static constexpr std::array<std::array<double, 3>, 4> kRamp{
      {{49, 85, 164}, {226, 232, 236}, {246, 205, 82}, {196, 38, 46}}};
  const double place = (value > 0 ? std::min(value, 1.0) : 0) * (kRamp.size() - 1);  // NaN is 0
  const size_t step = std::min(static_cast<size_t>(place), kRamp.size() - 2);
  const double part = place - static_cast<double>(step);
  Colour out{};
  for (size_t k = 0; k < 3; ++k) {
    out[k] = static_cast<uint8_t>(kRamp[step][k] + part * (kRamp[step + 1][k] - kRamp[step][k]));
  }
  return out;
}

}  // namespace reeb::tools
