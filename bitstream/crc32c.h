// CRC-32C (Castagnoli, reflected polynomial 0x82F63B78), the checksum of every chunk.
#pragma once

#include <cstdint>
#include <span>

namespace reeb {

/// Checksum of `bytes`; pass the result for the bytes before as `previous` to go on. The sum of no
/// bytes is 0.
uint32_t crc32c(std::span<const uint8_t> bytes, uint32_t previous = 0);

}  // namespace reeb
