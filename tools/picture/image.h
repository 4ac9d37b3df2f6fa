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

/// `part` (0 .. 1) of `over`, the rest of `under`.
Colour mixed(const Colour& under, const Colour& over, double part);

struct Point {
  double x = 0;  ///< pixels from the left
  double y = 0;  ///< from the top
};

/// A thick line with round ends; a disc where both ends are one point. Clipped at the borders.
void draw_line(Point from, Point to, double radius, Colour colour, Image& out);

inline constexpr int kTextHeight = 18;  ///< of a line of `draw_text`

/// Draws printable ASCII, "?" for any other byte. Clipped at the borders.
void draw_text(const std::string& text, int left, int top, Colour colour, Image& out);
int text_width(const std::string& text);

}  // namespace reeb::tools
