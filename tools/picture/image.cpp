#include "tools/picture/image.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace reeb::tools {

static_assert(sizeof(Colour) == 3 && std::is_trivially_copyable_v<Colour>,
              "libpng reads the pixels as bytes");

Status encode_png(const Image& image, std::string& out) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  bool written =
      png_image_write_get_memory_size(png, size, 0, image.pixels.data(), 0, nullptr) != 0;
  if (written) {
    out.resize(size);
    written =
        png_image_write_to_memory(&png, out.data(), &size, 0, image.pixels.data(), 0, nullptr) != 0;
  }
  return written ? Status()
                 : Status::io(std::string("the picture cannot be coded: ") + png.message);
}

void paste_shrunk(const Image& tile, int factor, int left, int top, Image& out) {
  for (int y = 0; y < tile.height / factor; ++y) {
    for (int x = 0; x < tile.width / factor; ++x) {
      std::array<int, 3> sum{};
      for (int i = 0; i < factor * factor; ++i) {
        const Colour& c = tile.at(x * factor + i % factor, y * factor + i / factor);
        for (size_t k = 0; k < 3; ++k) sum[k] += c[k];
      }
      Colour& pixel = out.at(left + x, top + y);
      for (size_t k = 0; k < 3; ++k) pixel[k] = static_cast<uint8_t>(sum[k] / (factor * factor));
    }
  }
}

Colour mixed(const Colour& under, const Colour& over, double part) {
  Colour out{};
  for (size_t k = 0; k < 3; ++k) {
    out[k] = static_cast<uint8_t>(std::lround(under[k] + part * (over[k] - under[k])));
  }
  return out;
}

void draw_line(Point from, Point to, double radius, Colour colour, Image& out) {
  const auto pixel = [](double place, int end) {
    return static_cast<int>(std::clamp(place, 0.0, 1.0 * end));
  };
  const int left = pixel(std::min(from.x, to.x) - radius, out.width);
  const int right = pixel(std::max(from.x, to.x) + radius + 1, out.width);
  const int top = pixel(std::min(from.y, to.y) - radius, out.height);
  const int bottom = pixel(std::max(from.y, to.y) + radius + 1, out.height);
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double squared = dx * dx + dy * dy;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const double px = x + 0.5 - from.x;
      const double py = y + 0.5 - from.y;
      const double along = squared > 0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0;
      if (std::hypot(px - along * dx, py - along * dy) <= radius) out.at(x, y) = colour;
    }
  }
}

}  // namespace reeb::tools
