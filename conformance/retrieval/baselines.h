// Plain descriptions of shapes to compare with.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace reeb::conformance {

struct Baselines {
  std::vector<double> shape_dna;       ///< 20 eigenvalues times the area, the i-th divided by i;
                                       ///< compared by L2 (M. Reuter, F. Wolter, N. Peinecke, 2006)
  std::vector<double> heat_histogram;  ///< of the heat kernel signature at 10 times from 0.1 to 5
                                       ///< over the first eigenvalue, 64 bins each; L1
  std::vector<double> d2;  ///< histogram of distances of random points, 64 bins; L1 (R. Osada,
                           ///< T. Funkhouser, B. Chazelle, D. Dobkin, 2002)
};

Baselines describe(std::span<const float> positions, std::span<const uint32_t> triangles);

}  // namespace reeb::conformance
