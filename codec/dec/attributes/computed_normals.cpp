#include "codec/dec/attributes/computed_normals.h"

#include <utility>

#include "codec/dec/normals.h"

namespace reeb {

namespace {

/// Positions of the sites, and the normals that follow from them.
class SmoothNormals {
 public:
  SmoothNormals(const SiteMesh& sites, std::span<const float> xyz)
      : sums(size_t{3} * sites.count), normals(size_t{3} * sites.count) {
    for (const uint32_t v : sites.vertex) {
      const auto at = xyz.begin() + 3 * static_cast<ptrdiff_t>(v);
      of_wedges_.insert(of_wedges_.end(), at, at + 3);
    }
    positions = sites.vertex.empty() ? xyz.data() : of_wedges_.data();
    vertex_normals(sites.triangles, positions, 3, sums, normals.data(), 3);
  }
  SmoothNormals(const SmoothNormals&) = delete;
  SmoothNormals& operator=(const SmoothNormals&) = delete;

  const float* positions;  ///< those given, or, of wedges, those of their vertices
  std::vector<double> sums;
  std::vector<float> normals;

 private:
  std::vector<float> of_wedges_;
};

/// Of every site, from it to the next corner of its first triangle.
std::vector<Direction> first_edges(const SiteMesh& sites, const float* xyz) {
  std::vector<Direction> out(sites.count);
  std::vector<bool> known(sites.count);
  for (size_t i = 0; i < sites.triangles.size(); ++i) {
    const uint32_t from = sites.triangles[i];
    if (known[from]) continue;
    known[from] = true;
    const uint32_t to = sites.triangles[i % 3 == 2 ? i - 2 : i + 1];
    for (size_t a = 0; a < 3; ++a)
      out[from][a] = double{xyz[size_t{to} * 3 + a]} - double{xyz[size_t{from} * 3 + a]};
  }
  return out;
}

}  // namespace

std::vector<float> computed_normals(const SiteMesh& sites, std::span<const float> xyz) {
  return std::move(SmoothNormals(sites, xyz).normals);
}

std::vector<NormalFrame> normal_frames(const SiteMesh& sites, std::span<const float> xyz) {
  const SmoothNormals smooth(sites, xyz);
  const std::vector<double>& sums = smooth.sums;
  const std::vector<Direction> edges = first_edges(sites, smooth.positions);
  std::vector<NormalFrame> out;
  out.reserve(sites.count);
  for (size_t s = 0; s < sites.count; ++s)
    out.emplace_back(Direction{sums[3 * s], sums[3 * s + 1], sums[3 * s + 2]}, edges[s]);
  return out;
}

std::vector<float> turned_normals(const SiteMesh& sites, std::span<const float> xyz,
                                  std::span<const float> corrections) {
  const std::vector<NormalFrame> frames = normal_frames(sites, xyz);
  std::vector<float> out;
  out.reserve(size_t{3} * sites.count);
  for (size_t s = 0; s < sites.count; ++s) {
    const auto normal =
        frames[s].turned(double{corrections[2 * s]}, double{corrections[2 * s + 1]});
    out.insert(out.end(), normal.begin(), normal.end());
  }
  return out;
}

uint64_t turned_normals_memory(const SiteMesh& sites) {
  constexpr uint64_t kPerSite = 3 * (2 * sizeof(float) + sizeof(double)) + sizeof(Direction) + 1 +
                                sizeof(NormalFrame) + 3 * sizeof(float);
  constexpr uint64_t kPerWedge = 3 * 2 * sizeof(float);
  return sites.count * kPerSite + sites.vertex.size() * kPerWedge;
}

}  // namespace reeb
