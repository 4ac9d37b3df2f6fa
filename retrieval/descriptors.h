// Descriptions of a whole surface, none of which minds how it is bent, or how large it is.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "retrieval/patch.h"
#include "segmentation/eigenpairs.h"
#include "segmentation/laplacian.h"

namespace reeb::retrieval {

/// Values with weights, e.g. one per vertex with its area.
using Weighted = std::vector<std::pair<double, double>>;

/// Values below which (i + 0.5) / count of the weight lies, i = 0 .. count-1; zeros of nothing.
std::vector<double> quantiles(Weighted values, int count);

/// The smallest eigenpairs of a piece of a surface.
struct PieceSpectrum {
  segmentation::Eigenpairs pairs;
  Eigen::VectorXd mass;  ///< area per vertex
};

inline constexpr int kScales = 12;    ///< times, or energies
inline constexpr int kQuantiles = 8;  ///< quantiles of each

/// Quantiles over a surface, made of pieces of `area` in all, of the logarithm of
/// - the heat kernel signature (J. Sun, M. Ovsjanikov, L. Guibas, "A concise and provably
/// informative
///   multi-scale signature based on heat diffusion", 2009), times the area, at kScales times;
/// - the wave kernel signature (M. Aubry, U. Schlickewei, D. Cremers, "The wave kernel signature",
///   2011), times the area, at kScales energies.
/// [scale][quantile].
std::vector<double> heat_quantiles(std::span<const PieceSpectrum> pieces, double area);
std::vector<double> wave_quantiles(std::span<const PieceSpectrum> pieces, double area);

/// Distances in space over distances along the surface (its edges), between vertices far apart from
/// each other and all vertices, weighted by area and by the latter distance.
Weighted straightness(const Surface& surface, const Eigen::VectorXd& mass);

/// asinh of the mean curvature times `unit`, a length, weighted by area; 1 / radius on a sphere.
/// Positive where the surface is convex as seen from outside, that is, from where its triangles
/// turn to the left on the whole about `centre`.
Weighted curvatures(const Surface& surface, const segmentation::Laplacian& laplacian,
                    const Point& centre, double unit);

/// Logarithm of the distance to `centre` over `unit`, weighted by area.
Weighted reaches(const Surface& surface, const Eigen::VectorXd& mass, const Point& centre,
                 double unit);

Point area_centre(std::span<const Surface> surfaces);

}  // namespace reeb::retrieval
