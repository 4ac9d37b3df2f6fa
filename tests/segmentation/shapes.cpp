#include "tests/segmentation/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace reeb::segmentation::shapes {
namespace {

using Point = Eigen::Vector3d;

void add_point(Mesh& mesh, const Point& p) {
  for (int i = 0; i < 3; ++i) mesh.positions.push_back(static_cast<float>(p[i]));
}

void add_quad(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
}

// Collects the zero set inside tetrahedra; a vertex lies on each grid edge whose ends differ in
// sign.
class TetrahedronMarcher {
 public:
  TetrahedronMarcher(const std::function<double(const Point&)>& value, double half, int cells)
      : half_(half), cells_(cells) {
    const int n = cells + 1;
    for (int i = 0; i < n * n * n; ++i) values_.push_back(value(point(i)));
  }

  Mesh run() {
    // Six tetrahedra around the diagonal of the cube, one for each order of the three axes.
    const int n = cells_ + 1;
    const std::array<int, 3> axis = {1, n, n * n};
    std::array<int, 3> order = {0, 1, 2};
    do {
      for (int z = 0; z < cells_; ++z) {
        for (int y = 0; y < cells_; ++y) {
          for (int x = 0; x < cells_; ++x) {
            std::array<int, 4> corner = {x + n * (y + n * z)};
            for (int i = 0; i < 3; ++i) corner[i + 1] = corner[i] + axis[order[i]];
            march(corner);
          }
        }
      }
    } while (std::next_permutation(order.begin(), order.end()));
    return std::move(mesh_);
  }

 private:
  Point point(int i) const {
    const int n = cells_ + 1;
    const Point index(i % n, i / n % n, i / (n * n));
    return half_ * (2.0 / cells_ * index - Point::Ones());
  }

  uint32_t vertex_on(int a, int b) {
    const auto [at, fresh] = vertices_.try_emplace(std::minmax(a, b), mesh_.vertex_count());
    if (fresh) {
      const double share = values_[a] / (values_[a] - values_[b]);
      add_point(mesh_, point(a) + share * (point(b) - point(a)));
    }
    return at->second;
  }

  void march(const std::array<int, 4>& corner) {
    std::vector<int> in, out;
    for (const int c : corner) (values_[c] < 0 ? in : out).push_back(c);
    if (in.empty() || out.empty()) return;
    const size_t first = mesh_.triangles.size();
    if (in.size() == 2) {
      add_quad(mesh_, vertex_on(in[0], out[0]), vertex_on(in[0], out[1]), vertex_on(in[1], out[1]),
               vertex_on(in[1], out[0]));
    } else {
      const auto& [one, three] = in.size() == 1 ? std::tie(in, out) : std::tie(out, in);
      for (const int c : three) mesh_.triangles.push_back(vertex_on(one[0], c));
    }
    // All triangles turn the same way as seen from outside.
    const Point outwards = centre(out) - centre(in);
    for (size_t t = first; t < mesh_.triangles.size(); t += 3) {
      const Point a = vertex(t), u = vertex(t + 1) - a, w = vertex(t + 2) - a;
      if (u.cross(w).dot(outwards) < 0) std::swap(mesh_.triangles[t], mesh_.triangles[t + 1]);
    }
  }

  Point centre(const std::vector<int>& corners) const {
    Point sum = Point::Zero();
    for (const int c : corners) sum += point(c);
    return sum / static_cast<double>(corners.size());
  }

  Point vertex(size_t corner) const {
    const float* p = &mesh_.positions[3 * mesh_.triangles[corner]];
    return {p[0], p[1], p[2]};
  }

  double half_;
  int cells_;
  std::vector<double> values_;
  std::map<std::pair<int, int>, uint32_t> vertices_;
  Mesh mesh_;
};

}  // namespace

void Mesh::append(const Mesh& other) {
  const uint32_t first = vertex_count();
  positions.insert(positions.end(), other.positions.begin(), other.positions.end());
  for (const uint32_t v : other.triangles) triangles.push_back(first + v);
}

Mesh ellipsoid(int times, double x, double y, double z) {
  std::vector<Point> points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Mesh mesh;
  mesh.triangles = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  for (int time = 0; time < times; ++time) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [at, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(points.size()));
      if (fresh) points.push_back((points[a] + points[b]).normalized());
      return at->second;
    };
    std::vector<uint32_t> finer;
    for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
      const uint32_t a = mesh.triangles[i], b = mesh.triangles[i + 1], c = mesh.triangles[i + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    mesh.triangles = std::move(finer);
  }
  for (const Point& p : points) add_point(mesh, p.cwiseProduct(Point(x, y, z)));
  return mesh;
}

Mesh torus(int around, int across, double ring_radius, double tube_radius) {
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double w = 2 * std::numbers::pi * j / across;
      const double r = ring_radius + tube_radius * std::cos(w);
      add_point(mesh, {r * std::cos(u), r * std::sin(u), tube_radius * std::sin(w)});
      const uint32_t next = static_cast<uint32_t>((i + 1) % around * across);
      const uint32_t here = static_cast<uint32_t>(i * across), k = static_cast<uint32_t>(j);
      const uint32_t k1 = static_cast<uint32_t>((j + 1) % across);
      add_quad(mesh, here + k, next + k, next + k1, here + k1);
    }
  }
  return mesh;
}

Mesh open_cylinder(int around, int along, double radius, double length) {
  Mesh mesh;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double u = 2 * std::numbers::pi * i / around;
      add_point(mesh, {radius * std::cos(u), radius * std::sin(u), length * j / along});
      if (j == along) continue;
      const uint32_t row = static_cast<uint32_t>(j * around), k = static_cast<uint32_t>(i);
      const uint32_t k1 = static_cast<uint32_t>((i + 1) % around);
      const uint32_t above = row + static_cast<uint32_t>(around);
      add_quad(mesh, row + k, row + k1, above + k1, above + k);
    }
  }
  return mesh;
}

Mesh cone(uint32_t triangles) {
  Mesh mesh;
  add_point(mesh, {0, 0, 1});
  for (uint32_t i = 0; i < triangles; ++i) {
    const double a = 2 * std::numbers::pi * i / triangles;
    add_point(mesh, {std::cos(a), std::sin(a), 0});
    mesh.triangles.insert(mesh.triangles.end(), {0, 1 + i, 1 + (i + 1) % triangles});
  }
  return mesh;
}

Mesh implicit_surface(const std::function<double(const Point&)>& value, double half, int cells) {
  return TetrahedronMarcher(value, half, cells).run();
}

double capsule(const Point& p, const Point& a, const Point& b, double radius) {
  const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - along * (b - a)).norm() - radius;
}

Mesh square(int cells, double size) {
  Mesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      add_point(mesh, {size * i / cells, size * j / cells, 0});
      if (i == cells || j == cells) continue;
      const uint32_t corner = static_cast<uint32_t>(j * (cells + 1) + i);
      const uint32_t above = corner + static_cast<uint32_t>(cells) + 1;
      add_quad(mesh, corner, corner + 1, above + 1, above);
    }
  }
  return mesh;
}

Surface surface_of(const Mesh& mesh) {
  Surface surface;
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    surface.points.emplace_back(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
  }
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    surface.triangles.push_back({mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  }
  connect(surface);
  return surface;
}

int euler_characteristic(const Mesh& mesh) {
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (size_t i = 0; i < mesh.triangles.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k) {
      edges.insert(std::minmax(mesh.triangles[i + k], mesh.triangles[i + (k + 1) % 3]));
    }
  }
  return static_cast<int>(mesh.vertex_count()) - static_cast<int>(edges.size()) +
         static_cast<int>(mesh.triangles.size() / 3);
}

}  // namespace reeb::segmentation::shapes
