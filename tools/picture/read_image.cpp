#include "tools/picture/read_image.h"

#include <climits>
#include <memory>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#include <stb/stb_image.h>

namespace reeb::tools {

Status decode_image(std::string_view bytes, Image& out) {
  constexpr int64_t kMaxPixels = int64_t{1} << 28;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const Status wrong = Status::corrupt("not a PNG, JPEG, BMP or TGA that can be read");
  if (bytes.size() > INT_MAX) return wrong;
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0 ||
      int64_t{width} * height > kMaxPixels)
    return wrong;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 3), stbi_image_free);
  if (!pixels || width < 1 || height < 1) return wrong;
  out = Image(width, height);
  for (size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] = {pixels.get()[3 * i], pixels.get()[3 * i + 1], pixels.get()[3 * i + 2]};
  return {};
}

}  // namespace reeb::tools
