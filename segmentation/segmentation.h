// Segmentation of a triangle mesh by the Reeb graph of a heat-diffusion function.
//
// Each connected piece of the surface is treated by itself: the extremities of the shape are found,
// every vertex gets its diffusion distance to the nearest extremity, the Reeb graph of that
// function is swept, and each of its arcs becomes a region, as does the body where arcs meet (M.
// Hachani, "Reeb Graph Modeling of 3-D Animated Meshes", thesis, 2015). Nothing here knows of
// streams or codecs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reeb::segmentation {

/// All constants of the segmentation. None has a unit of length: a scaled mesh gives the same
/// regions.
struct Options {
  /// Eigenpairs of the Laplace-Beltrami operator per piece, the constant one counted; 2 .. 1000.
  uint32_t eigenpairs = 60;
  /// Diffusion time, in units of 1 / (first non-zero eigenvalue); 0.001 .. 10.
  double diffusion_time = 0.2;
  /// An extremity must stand out by this part of the range of its distance function; 0 .. 1.
  double feature_persistence = 0.04;
  /// Radius in which two extrema are the same extremity, in units of sqrt(area); 0 .. 1.
  double feature_radius = 0.12;
  /// Arcs of the graph shorter than this part of the range of the function are cancelled; 0 .. 1.
  double graph_persistence = 0.08;
  /// Interval of the function, from a branching into an arc, in which the border looks for a
  /// concavity; 0 .. 1.
  double border_window = 0.08;
  /// The body where arcs meet is a region of its own from this part of the vertices of its piece
  /// on; 0 .. 1.
  double min_body = 0.02;
  /// A piece of fewer vertices is one region, without a spectral analysis; 4 .. 1000000.
  uint32_t min_piece_vertices = 40;
  /// Regions at most; pieces beyond it join the nearest region in space; 1 .. 4096.
  uint32_t max_regions = 1024;
  /// Boundary vertices of equal position count as one, so that texture seams do not cut the
  /// surface.
  bool weld = true;
};

inline constexpr uint32_t kNoRegion = 0xffffffffu;

enum class NodeType : uint8_t { kMinimum, kMaximum, kSaddle };

/// A critical point of the scalar function.
struct Node {
  uint32_t vertex = 0;  ///< 0 .. V-1
  double value = 0;     ///< f at the vertex, 0 .. 1
  NodeType type = NodeType::kMinimum;
  uint32_t component = 0;       ///< connected piece of the surface, 0 .. component_count-1
  uint32_t region = kNoRegion;  ///< the body around a branching that is no arc's, if there is one
};

/// A family of contours between two critical points.
struct Arc {
  uint32_t from = 0, to = 0;  ///< nodes; equal for an arc that returns to its node
  uint32_t region = 0;        ///< label of the vertices of this arc
};

struct Graph {
  std::vector<Node> nodes;
  std::vector<Arc> arcs;
  uint32_t component_count = 0;

  /// Independent cycles; for a closed orientable manifold the sum of the genera of its components.
  uint32_t loops() const;
};

/// Two regions that touch, or that are next to each other in space without touching.
struct RegionLink {
  uint32_t a = 0, b = 0;  ///< regions, a < b
  double border = 0;  ///< length of the common border in units of the input; 0 for a gap in space
  double gap = 0;  ///< distance of the centroids across a gap, in units of the input; 0 at a border
};

struct Result {
  std::vector<uint32_t> labels;  ///< per vertex, 0 .. region_count-1, every value used
  uint32_t region_count = 0;     ///< 0 only for an input without vertices
  std::vector<double> scalar;    ///< f per vertex, 0 .. 1; 0 where no function could be computed
  std::vector<uint32_t> feature_points;  ///< vertices, ascending
  Graph graph;
  std::vector<RegionLink> links;      ///< of the region adjacency; connects all regions
  std::vector<double> region_areas;   ///< per region, units of the input squared
  std::vector<std::string> warnings;  ///< for a person to read; empty when all went well
};

/// Segments the mesh of V = positions.size() / 3 vertices (x, y, z each) and triangles.size() / 3
/// triangles (three vertex indices each). Never fails: triangles with an index out of range, a
/// repeated index or a vertex that is not finite are ignored with a warning, and the worst input
/// gives one region. The same input gives the same result on the same machine, in every unit that
/// is a power of two.
Result segment(std::span<const float> positions, std::span<const uint32_t> triangles,
               const Options& options = {});

}  // namespace reeb::segmentation
