// Chunk framing: 4 letters of type, length (varuint), payload, CRC-32C over type and payload.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reeb {

/// First bytes of every file; the format version (one byte) follows. The first byte and the line
/// ends catch transfers that treat the file as text.
inline constexpr std::array<uint8_t, 7> kSignature = {0x89, 'R', 'E', 'E', 'B', '\r', '\n'};
inline constexpr size_t kPreambleBytes = kSignature.size() + 1;

/// Last bytes of a whole file: little-endian u32, bytes from the start of chunk `seek` to the end
/// of the file, then these four.
inline constexpr std::array<uint8_t, 4> kEndMark = {'r', 'e', 'e', 'b'};
inline constexpr size_t kTrailerBytes = 4 + kEndMark.size();

using ChunkType = std::array<uint8_t, 4>;

inline constexpr ChunkType kHeadChunk = {'H', 'E', 'A', 'D'};
inline constexpr ChunkType kReferenceChunk = {'R', 'E', 'F', 'M'};
inline constexpr ChunkType kGroupChunk = {'G', 'R', 'U', 'P'};
inline constexpr ChunkType kMetadataChunk = {'m', 'e', 't', 'a'};
inline constexpr ChunkType kAttributeChunk = {'a', 't', 't', 'r'};
inline constexpr ChunkType kAttributeGroupChunk = {'a', 'g', 'r', 'p'};
inline constexpr ChunkType kResourceChunk = {'r', 's', 'r', 'c'};
inline constexpr ChunkType kBoundsChunk = {'b', 'n', 'd', 's'};
inline constexpr ChunkType kSeekChunk = {'s', 'e', 'e', 'k'};

/// Upper case first letter: a reader that does not know the type must refuse the file.
inline bool is_critical(const ChunkType& type) { return type[0] >= 'A' && type[0] <= 'Z'; }
bool is_chunk_type(const ChunkType& type);  ///< four ASCII letters
inline std::string to_string(const ChunkType& type) { return {type.begin(), type.end()}; }

struct Chunk {
  ChunkType type{};
  uint64_t offset = 0;  ///< of the type, in the file
  uint64_t size = 0;    ///< bytes of the whole chunk
  uint64_t payload_offset = 0;
  uint64_t payload_size = 0;
  std::span<const uint8_t> payload;
  bool crc_ok = false;
};

/// Most bytes that type and length take.
inline constexpr size_t kMaxFrontBytes = 4 + 10;

enum class ChunkResult {
  kFound,    ///< framing read; look at `crc_ok`
  kCut,      ///< the file ends inside the chunk, as far as its length can be trusted
  kNoChunk,  ///< no chunk starts here
};

/// Reads type and length of the chunk that starts at `offset`, `available` bytes before the end;
/// `front`: the first of those, kMaxFrontBytes or all there are. Payload and checksum are left
/// alone.
ChunkResult read_chunk_front(std::span<const uint8_t> front, uint64_t offset, uint64_t available,
                             Chunk& chunk);

/// Reads the chunk that starts at `offset` (<= file.size()) of the file.
ChunkResult read_chunk(std::span<const uint8_t> file, uint64_t offset, Chunk& chunk);

/// Appends one chunk whose payload is `front` then `parts` one after another.
void append_chunk(std::vector<uint8_t>& out, const ChunkType& type, std::span<const uint8_t> front,
                  std::span<const std::span<const uint8_t>> parts = {});

}  // namespace reeb
