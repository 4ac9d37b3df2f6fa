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
#include "tools/picture/render.h"

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

/// A scene in POV-Ray's language and the size that it is made for.
struct PovrayScene {
  std::string text;
  uint32_t width = 0, height = 0;  ///< pixels
};

/// The frames (at least one) side by side from left to right, each centred in `tile` pixels of
/// width; regions coloured and translucent, the graph inside.
PovrayScene povray_scene(const PictureSubject& subject, const std::vector<PictureFrame>& frames,
                         const Camera& camera, uint32_t tile);

/// Renders a scene into the bytes of a PNG file with the command `povray`, which must be installed.
/// `threads` 0 = all cores.
Status render_povray(const PovrayScene& scene, unsigned threads, std::string& png);

}  // namespace reeb::tools
