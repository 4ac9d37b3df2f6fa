// Frames side by side: the original, what was decoded, and where they differ.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"
#include "tools/picture/attribute_paint.h"
#include "tools/picture/image.h"
#include "tools/picture/render.h"

namespace reeb::tools {

struct SheetOptions {
  std::vector<uint32_t> frames;  ///< from 0, each below the frame count; at least one
  int tile_width = 360;          ///< pixels of one frame
  int tile_height = 300;
  Camera camera = Camera::orbit(35, 12, false);
  std::string attribute = {};      ///< that gives the colours, where a shot has it
  ColourScale scale = {};          ///< of the attribute
  const Image* texture = nullptr;  ///< where a shot has texture coordinates, instead
};

/// `columns` frames, or all where there are fewer, from the first to the last.
std::vector<uint32_t> spread_frames(uint32_t frame_count, uint32_t columns);

/// One column per frame. Rows: `original`; where `other` is given (compared with success before),
/// it and the displacement of its vertices in colour, from 0 to the largest one shown. All frames
/// have one scale, each is centred by itself.
Image contact_sheet(const Sequence& original, const Sequence* other, const SheetOptions& options);

}  // namespace reeb::tools
