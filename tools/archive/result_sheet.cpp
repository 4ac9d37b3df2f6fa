#include "tools/archive/result_sheet.h"

#include <algorithm>

namespace reeb::tools {
namespace {

constexpr int kSupersampling = 3;
constexpr int kLineHeight = kTextHeight + 4;
constexpr double kFilled = 0.9;
constexpr Colour kInk{60, 60, 66};
constexpr Colour kClay{214, 196, 178};

Framing fit(std::span<const float> positions, const Camera& camera, int pixels) {
  const Vec3 centre = box_centre(positions);
  const auto [right, up] = half_extent(positions, camera, centre);
  const double extent = std::max({right, up, 1e-30});
  return {centre, kFilled * 0.5 * pixels / extent};
}

}  // namespace

void ResultSheet::add(const std::string& caption, const Sequence& sequence, uint32_t frame) {
  Image tile(options_.tile, options_.tile + kLineHeight);
  for (const Shot& shot : sequence.shots) {
    if (frame >= shot.frame_count) {
      frame -= shot.frame_count;
      continue;
    }
    const int pixels = options_.tile * kSupersampling;
    Image large(pixels, pixels);
    draw_mesh(shot.connectivity, shot.frame(frame), std::array<Colour, 1>{kClay}, options_.camera,
              fit(shot.frame(frame), options_.camera, pixels), large);
    paste_shrunk(large, kSupersampling, 0, 0, tile);
    break;
  }
  draw_text(caption, 4, options_.tile, kInk, tile);
  tiles_.push_back(std::move(tile));
}

Image ResultSheet::image() const {
  const int columns = std::clamp(static_cast<int>(tiles_.size()), 1, options_.columns);
  const int rows = (static_cast<int>(tiles_.size()) + columns - 1) / columns;
  const int height = options_.tile + kLineHeight;
  Image sheet(columns * options_.tile, rows * height);
  for (int i = 0; i < static_cast<int>(tiles_.size()); ++i)
    paste_shrunk(tiles_[i], 1, i % columns * options_.tile, i / columns * height, sheet);
  return sheet;
}

}  // namespace reeb::tools
