// Meshes read from bytes that a test writes down.
#pragma once

#include <catch2/catch.hpp>
#include <cstring>
#include <string>
#include <vector>

#include "tools/io/mesh_file.h"

namespace reeb::tools {

inline MeshFrame read_ok(const std::string& bytes, MeshFormat format,
                         const MeshReference* reference = nullptr) {
  MeshFrame out;
  const Status status = read_mesh(bytes, format, reference, out);
  INFO(status.message());
  REQUIRE(status.ok());
  return out;
}

/// The message of the failure that there must be.
inline std::string failure(const std::string& bytes, MeshFormat format) {
  MeshFrame out;
  const Status status = read_mesh(bytes, format, nullptr, out);
  REQUIRE_FALSE(status.ok());
  REQUIRE_FALSE(status.message().empty());
  return status.message();
}

inline bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

using Corners = std::vector<uint32_t>;

}  // namespace reeb::tools
