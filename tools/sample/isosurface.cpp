#include "tools/sample/isosurface.h"

#include <algorithm>

namespace reeb::tools {
namespace {

constexpr uint32_t kNone = UINT32_MAX;

class SurfaceNets {
 public:
  SurfaceNets(const Field& field, const Vec3& low, const Vec3& high, double cell)
      : low_(low), cell_(cell) {
    const Vec3 extent = (high - low) * (1 / cell);
    size_ = {static_cast<size_t>(extent.x) + 2, static_cast<size_t>(extent.y) + 2,
             static_cast<size_t>(extent.z) + 2};
    values_.reserve(size_[0] * size_[1] * size_[2]);
    for (size_t z = 0; z < size_[2]; ++z) {
      for (size_t y = 0; y < size_[1]; ++y) {
        for (size_t x = 0; x < size_[0]; ++x) values_.push_back(field(corner({x, y, z})));
      }
    }
    vertex_of_.assign(values_.size(), kNone);
  }

  TriangleMesh run() {
    for_each_cell([&](const Index& c) { add_vertex(c); });
    for_each_cell([&](const Index& c) {
      for (size_t axis = 0; axis < 3; ++axis) add_quad(c, axis);
    });
    return std::move(mesh_);
  }

 private:
  using Index = std::array<size_t, 3>;

  template <typename Body>
  void for_each_cell(const Body& body) {
    for (size_t z = 0; z + 1 < size_[2]; ++z) {
      for (size_t y = 0; y + 1 < size_[1]; ++y) {
        for (size_t x = 0; x + 1 < size_[0]; ++x) body(Index{x, y, z});
      }
    }
  }

  size_t linear(const Index& i) const { return (i[2] * size_[1] + i[1]) * size_[0] + i[0]; }
  double value(const Index& i) const { return values_[linear(i)]; }
  Vec3 corner(const Index& i) const {
    return low_ +
           Vec3{static_cast<double>(i[0]), static_cast<double>(i[1]), static_cast<double>(i[2])} *
               cell_;
  }
  static Index cube_corner(const Index& cell, size_t k) {
    return {cell[0] + (k & 1), cell[1] + (k >> 1 & 1), cell[2] + (k >> 2 & 1)};
  }

  // A cell that the surface crosses gets the mean of the crossings of its edges.
  void add_vertex(const Index& cell) {
    Vec3 sum;
    int crossings = 0;
    for (size_t a = 0; a < 8; ++a) {
      for (const size_t bit : {size_t{1}, size_t{2}, size_t{4}}) {
        const size_t b = a | bit;
        if (b == a) continue;
        const Index ia = cube_corner(cell, a);
        const Index ib = cube_corner(cell, b);
        const double fa = value(ia);
        const double fb = value(ib);
        if ((fa < 0) == (fb < 0)) continue;
        sum += corner(ia) + (corner(ib) - corner(ia)) * (fa / (fa - fb));
        ++crossings;
      }
    }
    if (crossings == 0) return;
    vertex_of_[linear(cell)] = static_cast<uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(sum * (1.0 / crossings));
  }

  // An edge that the surface crosses joins the vertices of the four cells around it.
  void add_quad(const Index& i, size_t axis) {
    Index next = i;
    ++next[axis];
    const bool inside = value(i) < 0;
    const size_t u = (axis + 1) % 3;
    const size_t v = (axis + 2) % 3;
    if (inside == (value(next) < 0) || i[u] == 0 || i[v] == 0) return;
    Index at = i;
    std::array<uint32_t, 4> quad{};
    quad[0] = vertex_of_[linear(at)];
    --at[u];
    quad[1] = vertex_of_[linear(at)];
    --at[v];
    quad[2] = vertex_of_[linear(at)];
    ++at[u];
    quad[3] = vertex_of_[linear(at)];
    if (!inside) std::swap(quad[1], quad[3]);
    split(quad);
  }

  // Along the shorter diagonal.
  void split(const std::array<uint32_t, 4>& q) {
    const auto& p = mesh_.vertices;
    if (length(p[q[0]] - p[q[2]]) <= length(p[q[1]] - p[q[3]])) {
      mesh_.triangles.push_back({q[0], q[1], q[2]});
      mesh_.triangles.push_back({q[0], q[2], q[3]});
    } else {
      mesh_.triangles.push_back({q[0], q[1], q[3]});
      mesh_.triangles.push_back({q[1], q[2], q[3]});
    }
  }

  Vec3 low_;
  double cell_;
  Index size_{};
  std::vector<double> values_;
  std::vector<uint32_t> vertex_of_;  ///< of each cell, at the index of its lowest corner
  TriangleMesh mesh_;
};

Vec3 gradient(const Field& field, const Vec3& p, double h) {
  const auto slope = [&](const Vec3& step) {
    return (field(p + step) - field(p - step)) / (2 * h);
  };
  return {slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
}

// One Newton step onto the zero set.
Vec3 onto_surface(const Field& field, const Vec3& p, double h) {
  const Vec3 g = gradient(field, p, h);
  const double g2 = dot(g, g);
  return g2 > 1e-6 ? p - g * (field(p) / g2) : p;
}

}  // namespace

TriangleMesh isosurface(const Field& field, const Vec3& low, const Vec3& high, double cell,
                        int relaxations) {
  TriangleMesh mesh = SurfaceNets(field, low, high, cell).run();
  const auto rings = vertex_rings(mesh);
  for (int round = 0; round < relaxations; ++round) {
    const std::vector<Vec3> before = mesh.vertices;
    for (size_t v = 0; v < before.size(); ++v) {
      Vec3 mean;
      for (const uint32_t n : rings[v]) mean += before[n];
      mean = mean * (1.0 / static_cast<double>(rings[v].size()));
      mesh.vertices[v] = onto_surface(field, before[v] + (mean - before[v]) * 0.5, 0.1 * cell);
    }
  }
  return mesh;
}

std::vector<std::vector<uint32_t>> vertex_rings(const TriangleMesh& mesh) {
  std::vector<std::vector<uint32_t>> rings(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      rings[t[i]].push_back(t[(i + 1) % 3]);
      rings[t[i]].push_back(t[(i + 2) % 3]);
    }
  }
  for (auto& ring : rings) {
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  }
  return rings;
}

}  // namespace reeb::tools
