#include "tests/codec/damage.h"

#include "bitstream/chunk.h"
#include "bitstream/crc32c.h"

namespace reeb::test {

void repair_checksums(std::vector<uint8_t>& file) {
  Chunk chunk;
  for (uint64_t at = kPreambleBytes; at < file.size(); at += chunk.size) {
    if (read_chunk(file, at, chunk) != ChunkResult::kFound) return;
    const uint32_t sum = crc32c(chunk.payload, crc32c(chunk.type));
    uint8_t* const out = &file[chunk.payload_offset + chunk.payload.size()];
    for (int i = 0; i < 4; ++i) out[i] = static_cast<uint8_t>(sum >> (8 * i));
  }
}

}  // namespace reeb::test
