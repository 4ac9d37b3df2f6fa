// Pictures in memory, and as PNG.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bitstream/status.h"

namespace reeb::tools {

using Colour = std::array<uint8_t, 3>;  ///< red, green, blue, sRGB

struct Image {
  Image(int w, int h, Colour fill = {255, 255, 255})
      : width(w), height(h), pixels(size_t{1} * w * h, fill) {}

  Colour& at(int x, int y) { return pixels[static_cast<size_t>(y) * width + x]; }
  const Colour& at(int x, int y) const { return pixels[static_cast<size_t>(y) * width + x]; }

  int width;
  int height;
  std::vector<Colour> pixels;  ///< rows from the top
};

/// The bytes of a PNG file.
Status encode_png(const Image& image, std::string& out);

/// Copies `tile`, shrunk `factor` times by averaging, to (left, top); all of it must fit.
void paste_shrunk(const Image& tile, int factor, int left, int top, Image& out);

/// Width of a glyph of `draw_text`, its gap included, and height of a line, at scale 1.
inline constexpr int kGlyphWidth = 6;
inline constexpr int kGlyphHeight = 7;

/// Draws capitals, digits and common signs; other characters leave a gap. Clipped at the borders.
void draw_text(const std::string& text, int left, int top, int scale, Colour colour, Image& out);

}  // namespace reeb::tools
