// Connectivity as Draco reads it.
#pragma once

#include <cstdint>
#include <span>

#include "codec/dec/connectivity/connectivity_decoder.h"

namespace reeb::test {

/// False where Draco refuses the section or leaves bytes of it.
bool read_by_draco(std::span<const uint8_t> section, PointTriangles& out);

}  // namespace reeb::test
