// Symmetric matrices stored by rows, up to the diagonal.
#pragma once

#include <cstdint>

namespace reeb {

/// Place of entry (i, j), j <= i; packed(n, 0) is how many entries a matrix of n rows has.
constexpr uint32_t packed(uint32_t i, uint32_t j) { return i * (i + 1) / 2 + j; }

}  // namespace reeb
