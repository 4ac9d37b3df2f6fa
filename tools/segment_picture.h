// A picture of a segmented sequence.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/base/sequence.h"
#include "segmentation/skeleton.h"
#include "tools/picture/render.h"

namespace reeb::tools {

/// Red, green and blue, 0 .. 1, of region `region`; consecutive regions differ clearly.
std::array<double, 3> region_colour(uint32_t region);

/// One mesh of the picture.
struct PictureFrame {
  uint32_t frame = 0;                ///< of the sequence, from 0
  std::span<const float> positions;  ///< [vertex][x, y, z], finite
  segmentation::SkeletonPose skeleton;
};

/// What all meshes of the picture have in common.
struct PictureSubject {
  const Connectivity* connectivity = nullptr;
  std::span<const uint32_t> labels;  ///< region per vertex
  const segmentation::Graph* graph = nullptr;
};

/// The frames (at least one) side by side from left to right, each centred in `tile` pixels of
/// width; regions coloured and, unless there are very many, numbered, the graph shining through.
Image segment_picture(const PictureSubject& subject, const std::vector<PictureFrame>& frames,
                      const Camera& camera, int tile);

}  // namespace reeb::tools
