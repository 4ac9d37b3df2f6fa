#include "bitstream/bytes.h"
#include "bitstream/container.h"
#include "bitstream/syntax.h"

namespace reeb {
namespace {

// Reads one header from `in` and appends its fields; a fault becomes a line of its own.
template <class Header>
bool trace_header(ByteReader& in, const Chunk& chunk, std::string& lines) {
  Header header;
  SyntaxReader reader(in, to_string(chunk.type));
  reader.trace_to(&lines, static_cast<size_t>(chunk.payload_offset));
  describe(reader, header);
  if (!reader.status().ok()) lines += "!   " + reader.status().message() + "\n";
  return reader.status().ok();
}

void trace_payload(const Chunk& chunk, std::string& lines) {
  ByteReader in(chunk.payload);
  if (chunk.type == kHeadChunk) trace_header<SequenceHeader>(in, chunk, lines);
  if (chunk.type == kMetadataChunk) trace_header<Metadata>(in, chunk, lines);
  if (chunk.type == kSeekChunk) trace_header<SeekTable>(in, chunk, lines);
  if (chunk.type == kGroupChunk) trace_header<GroupHeader>(in, chunk, lines);
  if (chunk.type == kAttributeGroupChunk) trace_header<AttributeGroupHeader>(in, chunk, lines);
  if (chunk.type == kResourceChunk) trace_header<ResourceHeader>(in, chunk, lines);
  if (chunk.type == kBoundsChunk) trace_header<GroupBoxes>(in, chunk, lines);
  if (chunk.type == kAttributeChunk && trace_header<AttributeHeader>(in, chunk, lines)) {
    trace_header<AttributeBody>(in, chunk, lines);
  }
  if (chunk.type == kReferenceChunk && trace_header<ReferenceHeader>(in, chunk, lines)) {
    trace_header<MeshHeader>(in, chunk, lines);
  }
}

void trace_chunk(const Chunk& chunk, std::string& lines) {
  lines += std::to_string(chunk.offset) + " " + to_string(chunk.type) + " payload " +
           std::to_string(chunk.payload.size()) + " bytes\n";
  trace_payload(chunk, lines);
  lines += std::to_string(chunk.offset + chunk.size - 4) + "   crc " +
           (chunk.crc_ok ? "right" : "WRONG") + "\n";
}

}  // namespace

std::string trace(std::span<const uint8_t> file) {
  if (file.size() < kPreambleBytes) return "! the file ends in its signature\n";
  const bool known = std::equal(kSignature.begin(), kSignature.end(), file.begin());
  std::string lines = known ? "0 signature\n" : "0 signature WRONG\n";
  lines += "7 format_version " + std::to_string(file[kSignature.size()]) + "\n";
  uint64_t offset = kPreambleBytes;
  while (offset < file.size()) {
    Chunk chunk;
    if (read_chunk(file, offset, chunk) != ChunkResult::kFound) break;
    trace_chunk(chunk, lines);
    offset += chunk.size;
    if (chunk.type != kSeekChunk) continue;
    ByteReader in(file.subspan(static_cast<size_t>(offset)));
    const uint32_t distance = in.u32();
    if (!in.ok()) break;
    lines += std::to_string(offset) + " trailer, seek chunk " + std::to_string(distance) +
             " bytes before the end\n";
    return lines;
  }
  return lines + "! " + std::to_string(file.size() - offset) +
         " bytes after the last whole chunk\n";
}

}  // namespace reeb
