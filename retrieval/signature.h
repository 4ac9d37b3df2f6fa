// What a shape is recognised by.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reeb::retrieval {

inline constexpr int kProfileLength = 16;
inline constexpr uint32_t kMaxCharts = 48;
inline constexpr int kSpectralValues = 96;
inline constexpr int kBodyValues = 32;

/// One Reeb chart. Lengths are in units of the shape's middle thickness, so that a part of a broken
/// shape has the numbers that it had before.
struct ChartSignature {
  bool annulus = false;              ///< or else a disc
  float share = 0;                   ///< of the shape's area, 0 .. 1
  float area = 0;                    ///< logarithm
  float girth = 0;                   ///< logarithm of the longer boundary over the root of the area
  float height = 0;                  ///< logarithm of an annulus's conformal modulus; 0 for a disc
  std::vector<float> area_stretch;   ///< kProfileLength values, from the middle outwards (Stretch)
  std::vector<float> angle_stretch;  ///< kProfileLength values
  std::vector<float> thickness;      ///< kProfileLength values: logarithms
  std::vector<uint8_t> neighbours;   ///< charts, ascending
};

struct Signature {
  std::vector<ChartSignature> charts;  ///< largest first, kMaxCharts at most
  std::vector<float> heat, wave;       ///< kSpectralValues each: heat_quantiles, wave_quantiles
  std::vector<float> thickness;  ///< kBodyValues quantiles of its logarithm, unit: root of the area
  std::vector<float> straightness;  ///< kBodyValues quantiles
  std::vector<float> curvature;     ///< kBodyValues quantiles, unit: root of the area
  std::vector<float> reach;         ///< kBodyValues quantiles, unit: root of the area

  /// A mesh without area has none.
  bool empty() const { return heat.empty(); }
};

struct Signed {
  Signature signature;
  std::vector<std::string> warnings;  ///< for a person to read; empty when all went well
};

/// Signs the mesh of V = positions.size() / 3 vertices and triangles.size() / 3 triangles. Never
/// fails: unusable triangles are left out with a warning, of many pieces the largest are signed,
/// and a mesh without any area has an empty signature. The same input gives the same signature on
/// the same machine.
Signed sign(std::span<const float> positions, std::span<const uint32_t> triangles);

/// As bytes: logarithms and parts in 1/1024, two bytes each.
std::vector<uint8_t> to_bytes(const Signature& signature);

/// False where these are not the bytes of a signature.
bool from_bytes(std::span<const uint8_t> bytes, Signature& out);

}  // namespace reeb::retrieval
