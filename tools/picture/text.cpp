// Words in pictures, from glyphs that bake_font has drawn.
#include <algorithm>
#include <cmath>

#include "tools/picture/image.h"

namespace reeb::tools {
namespace {

/// Where a glyph is in the atlas, and where it goes from the pen.
struct Glyph {
  int x, y, width, height;
  int left, top;   ///< from the pen on the baseline, down is positive
  double advance;  ///< of the pen
};

#include "glyphs.inc"

const Glyph& glyph_of(char c) {
  const bool printable = c >= ' ' && c <= '~';
  return kGlyphs[static_cast<size_t>((printable ? c : '?') - ' ')];
}

void draw_glyph(const Glyph& glyph, int left, int top, Colour colour, Image& out) {
  for (int y = 0; y < glyph.height; ++y) {
    for (int x = 0; x < glyph.width; ++x) {
      const int coverage = kAtlas[(glyph.y + y) * kAtlasWidth + glyph.x + x];
      const int right = left + x;
      const int down = top + y;
      if (right < 0 || down < 0 || right >= out.width || down >= out.height) continue;
      out.at(right, down) = mixed(out.at(right, down), colour, coverage / 255.0);
    }
  }
}

}  // namespace

int text_width(const std::string& text) {
  double pen = 0;
  for (const char c : text) pen += glyph_of(c).advance;
  return static_cast<int>(std::ceil(pen));
}

void draw_text(const std::string& text, int left, int top, Colour colour, Image& out) {
  double pen = left;
  for (const char c : text) {
    const Glyph& glyph = glyph_of(c);
    draw_glyph(glyph, static_cast<int>(std::lround(pen)) + glyph.left, top + kBaseline + glyph.top,
               colour, out);
    pen += glyph.advance;
  }
}

}  // namespace reeb::tools
