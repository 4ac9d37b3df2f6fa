// Draws the printable ASCII characters of a TrueType font into tables that text.cpp includes. Runs
// while building. Usage: bake_font FONT.ttf PIXELS > glyphs.inc
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

namespace {

constexpr int kFirst = ' ';
constexpr int kCount = '~' - ' ' + 1;
constexpr int kAtlasWidth = 256;

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::ifstream in(argv[1], std::ios::binary);
  const std::vector<char> file{std::istreambuf_iterator<char>(in), {}};
  const auto* font = reinterpret_cast<const unsigned char*>(file.data());
  const float pixels = std::strtof(argv[2], nullptr);
  std::array<stbtt_bakedchar, kCount> glyphs{};
  std::vector<uint8_t> atlas(size_t{kAtlasWidth} * 256);
  stbtt_fontinfo info;
  if (file.empty() || stbtt_InitFont(&info, font, 0) == 0) return 1;
  const int rows = stbtt_BakeFontBitmap(font, 0, pixels, atlas.data(), kAtlasWidth, 256, kFirst,
                                        kCount, glyphs.data());
  if (rows <= 0) return 1;
  int ascent = 0;
  stbtt_GetFontVMetrics(&info, &ascent, nullptr, nullptr);
  const float baseline = static_cast<float>(ascent) * stbtt_ScaleForPixelHeight(&info, pixels);

  std::printf("constexpr int kAtlasWidth = %d;\nconstexpr int kBaseline = %d;\n", kAtlasWidth,
              static_cast<int>(baseline + 0.5f));
  std::printf("constexpr Glyph kGlyphs[] = {\n");
  for (const stbtt_bakedchar& g : glyphs) {
    std::printf("{%d, %d, %d, %d, %.0f, %.0f, %.3f},\n", g.x0, g.y0, g.x1 - g.x0, g.y1 - g.y0,
                g.xoff, g.yoff, g.xadvance);
  }
  std::printf("};\nconstexpr uint8_t kAtlas[] = {\n");
  for (int i = 0; i < rows * kAtlasWidth; ++i)
    std::printf("%d,%s", atlas[static_cast<size_t>(i)], i % 64 == 63 ? "\n" : "");
  std::printf("};\n");
  return 0;
}
