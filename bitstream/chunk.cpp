#include "bitstream/chunk.h"

#include <algorithm>

#include "bitstream/bytes.h"
#include "bitstream/crc32c.h"

namespace reeb {

namespace {
constexpr size_t kCrcBytes = 4;
}

bool is_chunk_type(const ChunkType& type) {
  return std::all_of(type.begin(), type.end(),
                     [](uint8_t c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); });
}

ChunkResult read_chunk_front(std::span<const uint8_t> front, uint64_t offset, uint64_t available,
                             Chunk& chunk) {
  ByteReader in(front);
  const auto type = in.take(chunk.type.size());
  if (!in.ok()) return ChunkResult::kCut;
  std::copy(type.begin(), type.end(), chunk.type.begin());
  chunk.offset = offset;
  if (!is_chunk_type(chunk.type)) return ChunkResult::kNoChunk;
  chunk.payload_size = in.varuint();
  if (!in.ok()) return in.ran_out() ? ChunkResult::kCut : ChunkResult::kNoChunk;
  chunk.payload_offset = offset + in.position();
  const uint64_t rest = available - in.position();
  if (rest < kCrcBytes || chunk.payload_size > rest - kCrcBytes) return ChunkResult::kCut;
  chunk.size = in.position() + chunk.payload_size + kCrcBytes;
  return ChunkResult::kFound;
}

ChunkResult read_chunk(std::span<const uint8_t> file, uint64_t offset, Chunk& chunk) {
  const auto bytes = file.subspan(static_cast<size_t>(offset));
  const auto front = bytes.first(std::min(bytes.size(), kMaxFrontBytes));
  const ChunkResult result = read_chunk_front(front, offset, bytes.size(), chunk);
  if (result != ChunkResult::kFound) return result;
  const auto payload_size = static_cast<size_t>(chunk.payload_size);
  chunk.payload = file.subspan(static_cast<size_t>(chunk.payload_offset), payload_size);
  const uint32_t stored =
      ByteReader(bytes.subspan(static_cast<size_t>(chunk.size) - kCrcBytes)).u32();
  chunk.crc_ok = crc32c(chunk.payload, crc32c(chunk.type)) == stored;
  return ChunkResult::kFound;
}

void append_chunk(std::vector<uint8_t>& out, const ChunkType& type, std::span<const uint8_t> front,
                  std::span<const std::span<const uint8_t>> parts) {
  uint64_t length = front.size();
  for (const auto part : parts) length += part.size();
  out.insert(out.end(), type.begin(), type.end());
  append_varuint(out, length);
  out.insert(out.end(), front.begin(), front.end());
  uint32_t crc = crc32c(front, crc32c(type));
  for (const auto part : parts) {
    out.insert(out.end(), part.begin(), part.end());
    crc = crc32c(part, crc);
  }
  append_u32(out, crc);
}

}  // namespace reeb
