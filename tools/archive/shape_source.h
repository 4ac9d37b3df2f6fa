// The shapes in the files that a user names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "tools/archive/stored_signature.h"

namespace reeb::tools {

/// Files of `inputs` that hold shapes, sorted, each once, with absolute paths: mesh files, `.reeb`
/// streams and point caches with a mesh of the same name beside them, which is then no shape of its
/// own. Folders are looked through with all below them.
Status find_shape_files(const std::vector<std::string>& inputs,
                        std::vector<std::filesystem::path>& out);

/// A frame as plain arrays.
struct ShapeFrame {
  std::span<const float> positions;
  std::vector<uint32_t> triangles;
};
ShapeFrame shape_frame(const Sequence& sequence, uint32_t frame);

/// Signs at most `count` frames (at least 1) spread over the sequence. `complaint` says why there
/// is none where none could be signed.
std::vector<SignedFrame> sign_frames(const Sequence& sequence, uint32_t count,
                                     std::string& complaint);

}  // namespace reeb::tools
