// Numbers and faces into the text of a mesh file.
#pragma once

#include <array>
#include <charconv>
#include <span>
#include <string>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

/// The shortest text that reads back to the same value.
template <typename Number>
void append_number(std::string& out, Number value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  out.append(buffer.data(), end);
}

/// Calls row(corners of the face) for every face.
template <typename Row>
void for_each_face(const Connectivity& connectivity, const Row& row) {
  const uint32_t* corner = connectivity.corners.data();
  for (const uint32_t size : connectivity.face_sizes) {
    row(std::span<const uint32_t>(corner, size));
    corner += size;
  }
}

}  // namespace reeb::tools
