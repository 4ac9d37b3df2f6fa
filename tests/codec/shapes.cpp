#include "tests/codec/shapes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb::test {

namespace {

constexpr double kTurn = 6.283185307179586;

float sine(double x) { return static_cast<float>(std::sin(x)); }
float cosine(double x) { return static_cast<float>(std::cos(x)); }

void append(Shape& to, const Shape& from, float dx) {
  const uint32_t first = to.connectivity.vertex_count;
  for (size_t i = 0; i < from.positions.size(); i += 3) {
    to.add_vertex(from.positions[i] + dx, from.positions[i + 1], from.positions[i + 2]);
  }
  size_t at = 0;
  for (const uint32_t size : from.connectivity.face_sizes) {
    std::vector<uint32_t> face;
    for (uint32_t i = 0; i < size; ++i) face.push_back(first + from.connectivity.corners[at++]);
    to.add_face(face);
  }
}

}  // namespace

void Shape::add_face(const std::vector<uint32_t>& corners) {
  connectivity.face_sizes.push_back(static_cast<uint32_t>(corners.size()));
  connectivity.corners.insert(connectivity.corners.end(), corners.begin(), corners.end());
}

uint32_t Shape::add_vertex(float x, float y, float z) {
  positions.insert(positions.end(), {x, y, z});
  return connectivity.vertex_count++;
}

Shape tetrahedron() {
  Shape s{.name = "tetrahedron", .connectivity = {}, .positions = {}};
  s.add_vertex(0, 0, 0);
  s.add_vertex(1, 0, 0);
  s.add_vertex(0, 1, 0);
  s.add_vertex(0, 0, 1);
  for (const auto& f : {std::vector<uint32_t>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
    s.add_face(f);
  return s;
}

Shape strip(uint32_t triangles) {
  Shape s{.name = "strip", .connectivity = {}, .positions = {}};
  for (uint32_t i = 0; i < triangles + 2; ++i)
    s.add_vertex(static_cast<float>(i / 2), static_cast<float>(i % 2), 0);
  for (uint32_t i = 0; i < triangles; ++i)
    s.add_face(i % 2 == 0 ? std::vector{i, i + 2, i + 1} : std::vector{i, i + 1, i + 2});
  return s;
}

Shape doubled_strip(uint32_t vertices) {
  Shape s{.name = "doubled_strip", .connectivity = {}, .positions = {}};
  for (uint32_t v = 0; v < vertices; ++v)
    s.add_vertex(static_cast<float>(v / 2), static_cast<float>(v % 2), 0);
  for (uint32_t v = 0; v + 2 < vertices; ++v) {
    s.add_face({v, v + 1, v + 2});
    s.add_face({v, v + 1, v + 2});
  }
  return s;
}

Shape grid(uint32_t columns, uint32_t rows) {
  Shape s{.name = "grid", .connectivity = {}, .positions = {}};
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t x = 0; x < columns; ++x)
      s.add_vertex(static_cast<float>(x), static_cast<float>(y), sine(0.7 * x) * cosine(0.5 * y));
  }
  for (uint32_t y = 0; y + 1 < rows; ++y) {
    for (uint32_t x = 0; x + 1 < columns; ++x) {
      const uint32_t v = y * columns + x;
      s.add_face({v, v + 1, v + columns + 1, v + columns});
    }
  }
  return s;
}

Shape butterfly(uint32_t half, uint32_t rows) {
  Shape s{.name = "butterfly", .connectivity = {}, .positions = {}};
  const uint32_t columns = 2 * half + 1;
  for (uint32_t y = 0; y < rows; ++y) {
    for (uint32_t c = 0; c < columns; ++c) {
      const float side = c < half ? -1.0f : c > half ? 1.0f : 0.0f;
      const double off = c < half ? half - c : c - half;
      const float x = static_cast<float>(off) + 0.3f * sine(5 * off + 7 * y);
      s.add_vertex(side * x, static_cast<float>(y) + 0.3f * cosine(3 * off + 11 * y),
                   sine(off * y));
      if (c + 1 == columns || y + 1 == rows) continue;
      const uint32_t v = y * columns + c, above = v + columns;
      if (c >= half) {
        s.add_face({v, v + 1, above + 1});
        s.add_face({v, above + 1, above});
      } else {
        s.add_face({v, v + 1, above});
        s.add_face({v + 1, above + 1, above});
      }
    }
  }
  return s;
}

Shape torus(uint32_t around, uint32_t across) {
  Shape s{.name = "torus", .connectivity = {}, .positions = {}};
  for (uint32_t i = 0; i < around; ++i) {
    const double u = kTurn * i / around;
    for (uint32_t j = 0; j < across; ++j) {
      const double w = kTurn * j / across;
      const float radius = 3 + cosine(w);
      s.add_vertex(radius * cosine(u), radius * sine(u), sine(w));
      const uint32_t right = (i + 1) % around, up = (j + 1) % across;
      s.add_face({i * across + j, right * across + j, right * across + up});
      s.add_face({i * across + j, right * across + up, i * across + up});
    }
  }
  return s;
}

Shape hub(uint32_t spokes) {
  Shape s{.name = "hub", .connectivity = {}, .positions = {}};
  s.add_vertex(0, 0, 1);
  for (uint32_t i = 0; i < spokes; ++i) {
    s.add_vertex(cosine(kTurn * i / spokes), sine(kTurn * i / spokes), 0);
    s.add_face({0, i + 1, (i + 1) % spokes + 1});
  }
  return s;
}

Shape fins(uint32_t count) {
  Shape s{.name = "fins", .connectivity = {}, .positions = {}};
  s.add_vertex(0, 0, 0);
  s.add_vertex(0, 0, 1);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t v = s.add_vertex(cosine(kTurn * i / count), sine(kTurn * i / count), 0.5f);
    s.add_face({0, 1, v});
  }
  return s;
}

Shape two_components() {
  Shape s{.name = "two components", .connectivity = {}, .positions = {}};
  append(s, torus(9, 7), 0);
  append(s, tetrahedron(), 10);
  return s;
}

Shape with_isolated(Shape shape, uint32_t count) {
  Shape s{.name = shape.name + " with isolated vertices", .connectivity = {}, .positions = {}};
  for (uint32_t i = 0; i < count; ++i)
    s.add_vertex(sine(i), cosine(1.3 * i), static_cast<float>(i) / 4);
  append(s, shape, 0);
  s.add_vertex(5, 5, 5);
  return s;
}

Shape with_duplicates() {
  Shape s{.name = "duplicates", .connectivity = {}, .positions = {}};
  append(s, grid(12, 9), 0);
  append(s, grid(12, 9), 11);
  s.add_vertex(0, 0, 0);
  s.add_vertex(0, 0, 0);
  return s;
}

Shape mixed_polygons() {
  Shape s{.name = "mixed polygons", .connectivity = {}, .positions = {}};
  append(s, grid(6, 5), 0);
  const uint32_t a = s.add_vertex(-1, 0, 0), b = s.add_vertex(-2, 1, 0);
  const uint32_t c = s.add_vertex(-2, 2, 0), d = s.add_vertex(-1, 3, 0);
  s.add_face({0, 6, 12, d, c, b});
  s.add_face({0, b, a});
  s.add_face({12, 18, 24, c, d});
  s.add_face({a, a, b});
  s.add_face({5, 11});
  return s;
}

Shape single_vertex() {
  Shape s{.name = "single vertex", .connectivity = {}, .positions = {}};
  s.add_vertex(1, 2, 3);
  return s;
}

Shape points_only(uint32_t count) {
  Shape s{.name = "points", .connectivity = {}, .positions = {}};
  for (uint32_t i = 0; i < count; ++i) s.add_vertex(sine(3.0 * i), sine(5.1 * i), cosine(0.2 * i));
  return s;
}

std::vector<Shape> small_shapes() {
  return {tetrahedron(),     strip(20),        torus(16, 11),
          grid(9, 8),        hub(40),          fins(7),
          single_vertex(),   two_components(), with_isolated(torus(8, 6), 5),
          with_duplicates(), mixed_polygons(), points_only(30)};
}

std::vector<uint32_t> grid_triangles(uint32_t n) {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i + 1 < n; ++i) {
    for (uint32_t j = 0; j + 1 < n; ++j) {
      const uint32_t a = i * n + j;
      out.insert(out.end(), {a, a + 1, a + n, a + n, a + 1, a + n + 1});
    }
  }
  return out;
}

std::vector<uint32_t> triangles_of(const Connectivity& connectivity) {
  std::vector<uint32_t> out;
  size_t first = 0;
  for (const uint32_t size : connectivity.face_sizes) {
    const uint32_t* c = &connectivity.corners[first];
    for (uint32_t i = 2; i < size; ++i) {
      if (c[0] != c[i - 1] && c[i - 1] != c[i] && c[i] != c[0])
        out.insert(out.end(), {c[0], c[i - 1], c[i]});
    }
    first += size;
  }
  return out;
}

std::vector<int32_t> on_grid(const Shape& shape, uint32_t bits) {
  float low[3] = {1e30f, 1e30f, 1e30f}, high[3] = {-1e30f, -1e30f, -1e30f}, side = 0;
  for (size_t i = 0; i < shape.positions.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], shape.positions[i]);
    high[i % 3] = std::max(high[i % 3], shape.positions[i]);
  }
  for (int a = 0; a < 3; ++a) side = std::max(side, high[a] - low[a]);
  const float scale = side > 0 ? static_cast<float>((1u << bits) - 1) / side : 0;
  std::vector<int32_t> out;
  for (size_t i = 0; i < shape.positions.size(); ++i)
    out.push_back(static_cast<int32_t>((shape.positions[i] - low[i % 3]) * scale));
  return out;
}

void bend(const float* rest, double time, double* xyz) {
  const double x = rest[0], y = rest[1], z = rest[2];
  const double angle = 0.5 * std::sin(kTurn * time) * (1 + 0.2 * z);
  xyz[0] = x * std::cos(angle) - y * std::sin(angle) + 0.3 * time;
  xyz[1] = x * std::sin(angle) + y * std::cos(angle);
  xyz[2] = z + 0.3 * std::sin(1.1 * x + 2 * kTurn * time) + 0.1 * std::sin(2.3 * y - kTurn * time);
}

void rest(const float* rest, double, double* xyz) { std::copy(rest, rest + 3, xyz); }

Shot animate(const Shape& shape, uint32_t frames, const Motion& motion) {
  Shot out{shape.connectivity, frames, {}, {}};
  for (uint32_t t = 0; t < frames; ++t) {
    for (size_t i = 0; i < shape.positions.size(); i += 3) {
      double xyz[3];
      motion(&shape.positions[i], static_cast<double>(t) / frames, xyz);
      for (const double x : xyz) out.positions.push_back(static_cast<float>(x));
    }
  }
  return out;
}

Sequence sequence_of(std::vector<Shot> shots) {
  Sequence out;
  out.shots = std::move(shots);
  return out;
}

}  // namespace reeb::test
