// Changes of a mesh that should not change its segmentation.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace reeb::benchmark {

double mean_edge_length(std::span<const float> positions, std::span<const uint32_t> triangles);

/// Length of the diagonal of the bounding box.
double diagonal(std::span<const float> positions);

/// Adds normally distributed noise of standard deviation `sigma` to every coordinate; vertices
/// at one position stay together.
std::vector<float> add_noise(std::span<const float> positions, double sigma, std::mt19937& random);

/// Turns by a random rotation and scales by `factor`.
std::vector<float> turn_and_scale(std::span<const float> positions, double factor,
                                  std::mt19937& random);

struct DecimatedMesh {
  std::vector<float> positions;
  std::vector<uint32_t> triangles;
};

/// Collapses edges by quadric errors until half of the vertices are left.
DecimatedMesh decimate_to_half(std::span<const float> positions,
                               std::span<const uint32_t> triangles);

}  // namespace reeb::benchmark
