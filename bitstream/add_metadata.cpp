#include <algorithm>

#include "bitstream/bytes.h"
#include "bitstream/container.h"
#include "bitstream/syntax.h"

namespace reeb {
namespace {

template <class Header>
Status parse_chunk(const Chunk& chunk, Header& header) {
  ByteReader in(chunk.payload);
  return read_header(in, to_string(chunk.type), header);
}

/// Copies a file chunk by chunk, with more in its metadata, and a seek table to suit.
class MetadataAdder {
 public:
  MetadataAdder(std::span<const uint8_t> file, std::vector<uint8_t>& out)
      : file_(file), out_(out) {}

  Status run(const std::vector<MetadataEntry>& entries) {
    if (Status s = read_chunks(); !s.ok()) return s;
    for (const MetadataEntry& entry : entries) put(entry);
    out_.assign(file_.begin(), file_.begin() + kPreambleBytes);
    for (const Chunk& chunk : chunks_) {
      copy(chunk);
      if (chunk.type != kHeadChunk) continue;
      if (Status s = append(metadata_, kMetadataChunk); !s.ok()) return s;
    }
    const uint64_t start = out_.size();
    if (Status s = append(table_, kSeekChunk); !s.ok()) return s;
    append_u32(out_, static_cast<uint32_t>(out_.size() + kTrailerBytes - start));
    out_.insert(out_.end(), kEndMark.begin(), kEndMark.end());
    return {};
  }

 private:
  // Keeps the chunks that are copied as they are.
  Status read_chunks() {
    bool whole = false;
    for (uint64_t at = kPreambleBytes; !whole && at < file_.size();) {
      Chunk chunk;
      if (read_chunk(file_, at, chunk) != ChunkResult::kFound || !chunk.crc_ok) break;
      at += chunk.size;
      Status status;
      if (chunk.type == kMetadataChunk) {
        status = parse_chunk(chunk, metadata_);
      } else if (chunk.type == kSeekChunk) {
        status = parse_chunk(chunk, table_);
        whole = at + kTrailerBytes == file_.size();
      } else {
        chunks_.push_back(chunk);
      }
      if (!status.ok()) return status;
    }
    return whole ? Status() : Status::corrupt("metadata: the file is not whole");
  }

  void put(const MetadataEntry& entry) {
    auto& all = metadata_.entries;
    std::erase_if(all, [&](const MetadataEntry& e) { return e.key == entry.key; });
    all.push_back(entry);
  }

  void copy(const Chunk& chunk) {
    const bool noted = chunk.type == kReferenceChunk || chunk.type == kGroupChunk;
    if (noted && next_ < table_.entries.size()) {
      table_.entries[next_++].gap = out_.size() - noted_end_;
      noted_end_ = out_.size() + chunk.size;
    }
    const auto start = file_.begin() + static_cast<ptrdiff_t>(chunk.offset);
    out_.insert(out_.end(), start, start + static_cast<ptrdiff_t>(chunk.size));
  }

  template <class Header>
  Status append(const Header& header, const ChunkType& type) {
    std::vector<uint8_t> payload;
    Status status = write_header(header, to_string(type), payload);
    if (status.ok()) append_chunk(out_, type, payload);
    return status;
  }

  std::span<const uint8_t> file_;
  std::vector<uint8_t>& out_;
  std::vector<Chunk> chunks_;
  Metadata metadata_;
  SeekTable table_;
  size_t next_ = 0;         ///< entry of the table
  uint64_t noted_end_ = 0;  ///< of the chunk of the entry before
};

}  // namespace

Status add_metadata(std::span<const uint8_t> file, const std::vector<MetadataEntry>& entries,
                    std::vector<uint8_t>& out) {
  out.clear();
  if (file.size() < kPreambleBytes) return Status::corrupt("metadata: the file is not whole");
  Status status = MetadataAdder(file, out).run(entries);
  if (!status.ok()) out.clear();
  return status;
}

}  // namespace reeb
