// The file: a sequence header, one reference mesh per shot, groups of frames, metadata, a seek
// table.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bitstream/attribute_headers.h"
#include "bitstream/byte_source.h"
#include "bitstream/chunk.h"
#include "bitstream/headers.h"
#include "bitstream/limits.h"
#include "bitstream/memory_account.h"
#include "bitstream/status.h"

namespace reeb {

/// What follows the header of a group; a profile has none but its own.
struct GroupSections {
  std::span<const uint8_t> motion{}, coefficients{}, basis{}, corrections{};
  std::span<const uint8_t> differences{}, raw{};  ///< of a lossless group
};

/// A section of groups: what it is called, its length in the header, its place.
struct GroupSection {
  const char* name;
  uint64_t GroupHeader::*bytes;
  std::span<const uint8_t> GroupSections::*data;
};

/// In the order of the file.
inline constexpr GroupSection kGroupSections[] = {
    {"motion", &GroupHeader::motion_bytes, &GroupSections::motion},
    {"coefficients", &GroupHeader::coefficient_bytes, &GroupSections::coefficients},
    {"basis", &GroupHeader::basis_bytes, &GroupSections::basis},
    {"corrections", &GroupHeader::correction_bytes, &GroupSections::corrections},
    {"differences", &GroupHeader::difference_bytes, &GroupSections::differences},
    {"raw bits", &GroupHeader::raw_bytes, &GroupSections::raw},
};

/// Appends a file to a byte vector, chunk by chunk: `begin`, optionally `metadata`, for each shot
/// its `reference` and its groups in order of frames, `finish`. A field out of range is an invalid
/// argument.
class ContainerWriter {
 public:
  /// Appends to `out`, which must be empty and outlive the writer.
  explicit ContainerWriter(std::vector<uint8_t>& out) : out_(out) {}

  Status begin(const SequenceHeader& header);
  /// Writes nothing where `entries` is empty.
  Status metadata(const std::vector<MetadataEntry>& entries);
  /// `mesh`: bytes that start with a MeshHeader, as `encode_reference` makes them.
  Status reference(const ReferenceHeader& header, std::span<const uint8_t> mesh);
  /// The section lengths of `header` are taken from the spans.
  Status group(const GroupHeader& header, const GroupSections& sections);
  /// Behind the reference mesh of its shot; `values`: the section of a static attribute.
  Status attribute(const AttributeHeader& header, const AttributeBody& body,
                   std::span<const uint8_t> values);
  /// Behind its group; `sections`: as of `encode_attribute_group`.
  Status attribute_group(const AttributeGroupHeader& header, std::span<const uint8_t> sections);
  Status resource(const ResourceHeader& header, std::span<const uint8_t> bytes);
  Status bounds(const GroupBoxes& bounds);
  Status finish();

  /// Empties the output, whose bytes the caller has passed on; the file goes on behind them.
  void flush();

 private:
  void note_chunk(uint64_t start, uint32_t frame_count);
  uint64_t offset() const { return flushed_ + out_.size(); }

  std::vector<uint8_t>& out_;
  uint64_t flushed_ = 0;
  SeekTable table_;
  uint64_t noted_end_ = 0;
};

/// A copy of `file`, which must be whole, with `entries` in its metadata, in place of those there
/// that have their keys. `out` is empty after a failure.
Status add_metadata(std::span<const uint8_t> file, const std::vector<MetadataEntry>& entries,
                    std::vector<uint8_t>& out);

struct ReferenceChunk {
  ReferenceHeader header;
  MeshHeader mesh_header;         ///< peeked from the front of `mesh`
  std::span<const uint8_t> mesh;  ///< coded mesh, MeshHeader included
  uint64_t offset = 0, size = 0;  ///< of the whole chunk in the file, bytes
};

struct GroupChunk : GroupSections {
  GroupHeader header;
  uint64_t offset = 0, size = 0;  ///< of the whole chunk in the file, bytes

  bool continues() const { return (header.flags & GroupHeader::kContinues) != 0; }
};

/// What an attribute is, and, behind `header`, its body and values.
struct AttributeChunk {
  AttributeHeader header;
  std::span<const uint8_t> body;
  uint64_t offset = 0, size = 0;  ///< of the whole chunk in the file, bytes
};

struct AttributeGroupChunk {
  AttributeGroupHeader header;
  std::span<const uint8_t> sections;
  uint64_t offset = 0, size = 0;  ///< of the whole chunk in the file, bytes
};

struct ResourceChunk {
  ResourceHeader header;
  std::span<const uint8_t> bytes;
  uint64_t offset = 0, size = 0;  ///< of the whole chunk in the file, bytes
};

/// True where nothing is missing between the groups.
inline bool follows(const GroupChunk& group, const GroupChunk& before) {
  return group.header.shot == before.header.shot &&
         group.header.first_frame == before.header.first_frame + before.header.frame_count;
}

/// A stretch of the file that holds no chunk with a right checksum.
struct DamagedRange {
  std::string type;  ///< as read; empty where not even a type could be
  uint64_t offset = 0, size = 0;
};

/// Everything a file holds, found without decoding a mesh or a frame.
struct ContainerReader {
  uint8_t format_version = 0;
  SequenceHeader header;
  std::vector<ReferenceChunk> references;  ///< in order of shots
  std::vector<GroupChunk> groups;          ///< in order of frames; gaps where damaged or cut
  std::vector<MetadataEntry> metadata;
  std::vector<AttributeChunk> attributes;             ///< rising by shot and index
  std::vector<AttributeGroupChunk> attribute_groups;  ///< rising by first frame and index
  std::vector<ResourceChunk> resources;               ///< in order of the file
  std::vector<Box> bounds;  ///< of the groups; empty where the file does not tell
  std::vector<DamagedRange> damaged;
  bool truncated = false;  ///< the file ends early; what was whole before the cut is here
  /// Bytes of the file by section; the sum is the file's size.
  std::vector<std::pair<std::string, uint64_t>> sections;
  Lease lease;  ///< of the memory that all of it takes

  /// Reads `file`, which must outlive this object: spans point into it. A wrong checksum or a cut
  /// is reported in `damaged` and `truncated`; kCorrupt where bytes with a right checksum break the
  /// specification or the sequence header is lost; kUnsupported for a newer version or an unknown
  /// critical chunk; kLimitExceeded. What it takes of memory comes from `account`, which must
  /// outlive this object, too, or from one of its own.
  Status parse(std::span<const uint8_t> file, const Limits& limits, MemoryAccount& account);
  Status parse(std::span<const uint8_t> file, const Limits& limits);

  /// The same through a source, without reading the payloads of meshes and groups that an
  /// undamaged seek table leads to; `load_chunk` checks them. Spans stay empty.
  Status open(ByteSource& source, const Limits& limits, MemoryAccount& account);

  /// Reference mesh of a shot, nullptr where it was damaged.
  const ReferenceChunk* reference(uint32_t shot) const;
  /// nullptr where there is none, or it was damaged.
  const AttributeChunk* attribute(uint32_t shot, uint32_t index) const;
  const AttributeGroupChunk* attribute_group(uint32_t first_frame, uint32_t index) const;
};

/// Reads the chunk again, as a whole, and sets its spans, which point into `source` or `buffer`.
/// kCorrupt where its checksum is wrong or it has changed.
Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, ReferenceChunk& chunk);
Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, GroupChunk& chunk);
Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, AttributeChunk& chunk);
Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, AttributeGroupChunk& chunk);
Status load_chunk(ByteSource& source, std::vector<uint8_t>& buffer, ResourceChunk& chunk);

/// Text for people: every chunk and every header field as "offset name value", one a line, as far
/// as the bytes make sense.
std::string trace(std::span<const uint8_t> file);

}  // namespace reeb
