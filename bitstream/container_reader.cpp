#include <algorithm>

#include "bitstream/bytes.h"
#include "bitstream/container.h"
#include "bitstream/container_parser.h"
#include "bitstream/group_payload.h"
#include "bitstream/syntax.h"

namespace reeb {

Status read_group_payload(std::span<const uint8_t> payload, GroupChunk& g) {
  ByteReader in(payload);
  if (Status s = read_header(in, "GRUP", g.header); !s.ok()) return s;
  for (const GroupSection& s : kGroupSections) g.*s.data = in.take(g.header.*s.bytes);
  return in.ok() && in.remaining() == 0 ? Status()
                                        : Status::corrupt("GRUP: sections do not fill the chunk");
}

namespace {

Status read_payload(std::span<const uint8_t> payload, ReferenceChunk& r) {
  ByteReader in(payload);
  if (Status s = read_header(in, "REFM", r.header); !s.ok()) return s;
  r.mesh = payload.subspan(in.position());
  ByteReader mesh_in(r.mesh);
  return read_header(mesh_in, "mesh header", r.mesh_header);
}

Status read_payload(std::span<const uint8_t> payload, GroupChunk& g) {
  return read_group_payload(payload, g);
}

template <class AnyHeader>
Status read_rest(std::span<const uint8_t> payload, const char* name, AnyHeader& header,
                 std::span<const uint8_t>& rest) {
  ByteReader in(payload);
  if (Status s = read_header(in, name, header); !s.ok()) return s;
  rest = payload.subspan(in.position());
  return {};
}

Status read_payload(std::span<const uint8_t> payload, AttributeChunk& a) {
  return read_rest(payload, "attr", a.header, a.body);
}

Status read_payload(std::span<const uint8_t> payload, AttributeGroupChunk& a) {
  return read_rest(payload, "agrp", a.header, a.sections);
}

Status read_payload(std::span<const uint8_t> payload, ResourceChunk& r) {
  return read_rest(payload, "rsrc", r.header, r.bytes);
}

template <class AnyChunk>
bool same_headers(const AnyChunk& a, const AnyChunk& b) {
  return a.header == b.header;
}
bool same_headers(const ReferenceChunk& a, const ReferenceChunk& b) {
  return a.header == b.header && a.mesh_header == b.mesh_header;
}

template <class AnyChunk>
Status load(ByteSource& source, std::vector<uint8_t>& buffer, AnyChunk& chunk) {
  std::span<const uint8_t> bytes;
  if (Status s = source.read(chunk.offset, static_cast<size_t>(chunk.size), buffer, bytes); !s.ok())
    return s;
  Chunk framed;
  if (read_chunk(bytes, 0, framed) != ChunkResult::kFound || !framed.crc_ok ||
      framed.size != chunk.size) {
    return Status::corrupt("the chunk at byte " + std::to_string(chunk.offset) + " is damaged");
  }
  const AnyChunk before = chunk;
  if (Status s = read_payload(framed.payload, chunk); !s.ok()) return s;
  if (same_headers(chunk, before)) return {};
  chunk = before;
  return Status::corrupt("the chunk at byte " + std::to_string(chunk.offset) + " has changed");
}

}  // namespace

Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, ReferenceChunk& chunk) {
  return load(source, buffer, chunk);
}

Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, GroupChunk& chunk) {
  return load(source, buffer, chunk);
}

Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, AttributeChunk& chunk) {
  return load(source, buffer, chunk);
}

Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, AttributeGroupChunk& chunk) {
  return load(source, buffer, chunk);
}

Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, ResourceChunk& chunk) {
  return load(source, buffer, chunk);
}

Status ContainerReader::parse(std::span<const uint8_t> file, const Limits& limits) {
  MemoryAccount account(limits.max_memory);
  Status status = parse(file, limits, account);
  lease = {};
  return status;
}

Status ContainerReader::parse(std::span<const uint8_t> file, const Limits& limits,
                              MemoryAccount& account) {
  *this = {};
  MemorySource source(file);
  ContainerParser parser(source, limits, Checksums::kNow, account, *this);
  if (Status s = parser.advance(true); !s.ok()) return s;
  Status status;
  const auto load_all = [&](auto& chunks) {
    std::vector<uint8_t> unused;
    for (auto& chunk : chunks) {
      if (status.ok()) status = load_chunk(source, unused, chunk);
    }
  };
  load_all(references);
  load_all(groups);
  load_all(attributes);
  load_all(attribute_groups);
  load_all(resources);
  return status;
}

Status ContainerReader::open(ByteSource& source, const Limits& limits, MemoryAccount& account) {
  *this = {};
  return ContainerParser(source, limits, Checksums::kOnLoad, account, *this).advance(true);
}

const ReferenceChunk* ContainerReader::reference(uint32_t shot) const {
  const auto before = [](const ReferenceChunk& r, uint32_t s) { return r.header.shot < s; };
  const auto at = std::lower_bound(references.begin(), references.end(), shot, before);
  return at == references.end() || at->header.shot != shot ? nullptr : &*at;
}

const AttributeChunk* ContainerReader::attribute(uint32_t shot, uint32_t index) const {
  const auto key = [](const AttributeHeader& h) { return std::pair(h.shot, h.index); };
  const std::pair wanted(shot, index);
  const auto at =
      std::lower_bound(attributes.begin(), attributes.end(), wanted,
                       [&](const AttributeChunk& a, const auto& w) { return key(a.header) < w; });
  return at == attributes.end() || key(at->header) != wanted ? nullptr : &*at;
}

const AttributeGroupChunk* ContainerReader::attribute_group(uint32_t first_frame,
                                                            uint32_t index) const {
  const auto key = [](const AttributeGroupHeader& h) { return std::pair(h.first_frame, h.index); };
  const std::pair wanted(first_frame, index);
  const auto at = std::lower_bound(
      attribute_groups.begin(), attribute_groups.end(), wanted,
      [&](const AttributeGroupChunk& a, const auto& w) { return key(a.header) < w; });
  return at == attribute_groups.end() || key(at->header) != wanted ? nullptr : &*at;
}

}  // namespace reeb
