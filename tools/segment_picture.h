// A picture of a segmented sequence, rendered off-screen by POV-Ray.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "segmentation/skeleton.h"

namespace reeb::tools {

/// Red, green and blue, 0 .. 1, of region `region`; consecutive regions differ clearly.
std::array<double, 3> region_colour(uint32_t region);

/// One mesh of the picture.
struct PictureFrame {
  std::span<const float> positions;  ///< [vertex][x, y, z], finite
  segmentation::SkeletonPose skeleton;
};

/// What all meshes of the picture have in common.
struct PictureSubject {
  std::span<const uint32_t> triangles;  ///< three vertices each
  std::span<const uint32_t> labels;     ///< region per vertex
  const segmentation::Graph* graph = nullptr;
};

/// A POV-Ray scene: the frames side by side from left to right, each centred, y upwards, seen
/// across their widest horizontal extent; regions coloured and translucent, the graph inside.
std::string povray_scene(const PictureSubject& subject, const std::vector<PictureFrame>& frames,
                         uint32_t width, uint32_t height);

/// Renders a scene into the bytes of a PNG file with the command `povray`, which must be installed.
/// `threads` 0 = all cores.
Status render(const std::string& scene, uint32_t width, uint32_t height, unsigned threads,
              std::string& png);

}  // namespace reeb::tools
