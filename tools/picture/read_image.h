// Pictures from files.
#pragma once

#include <string_view>

#include "bitstream/status.h"
#include "tools/picture/image.h"

namespace reeb::tools {

/// The bytes of a PNG, JPEG, BMP or TGA file, of at most 2^28 pixels; alpha is left out.
Status decode_image(std::string_view bytes, Image& out);

}  // namespace reeb::tools
