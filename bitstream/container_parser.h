// Finds the chunks of a file and checks what they say against each other, as far as the file is
// there.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "bitstream/container.h"
#include "bitstream/memory_account.h"

namespace reeb {

/// When the checksums of `REFM` and `GRUP` chunks are checked.
enum class Checksums {
  kNow,
  kOnLoad,  ///< of those that the seek table knows; `load_chunk` does it
};

class ContainerParser {
 public:
  /// All references must outlive the parser, the account what is found, too: that is added to
  /// `out`, which is empty.
  ContainerParser(ByteSource& source, const Limits& limits, Checksums checksums,
                  MemoryAccount& account, ContainerReader& out)
      : source_(source), limits_(limits), checksums_(checksums), account_(account), out_(out) {}

  /// Reads on to the end of the source. `complete`: nothing comes after it; else a chunk that is
  /// not whole is left for the next call. Errors as of ContainerReader::parse.
  Status advance(bool complete);

  /// True when the sequence header is there.
  bool has_header() const { return has_header_; }

 private:
  /// A chunk as the seek table has it.
  struct Landmark {
    uint64_t offset = 0, size = 0;
    uint32_t frame_count = 0;
  };

  Status restart();
  bool fetch(uint64_t offset, uint64_t count, std::span<const uint8_t>& out);
  ChunkResult read(uint64_t offset, Chunk& chunk);
  bool check_crc(const Chunk& chunk);
  const Landmark* landmark_of(const Chunk& chunk) const;
  Status spend(uint64_t bytes, Lease& lease);
  template <class T>
  Status make_room(std::vector<T>& list, Lease& lease);
  Status read_metadata(const Chunk& chunk, Metadata& out, Lease& entries);
  Status read_seek_table(const Chunk& chunk, SeekTable& out, Lease& lease);
  Status read_preamble(bool complete);
  Status read_sequence_header(bool complete);
  std::optional<Chunk> find_seek_chunk();
  void find_landmarks();
  Status scan(bool complete);
  bool at_end();
  bool wait_or_skip(const Chunk& chunk, ChunkResult result, bool complete);
  void note_damage(const std::string& type, uint64_t size);
  void skip_damage(const Chunk& chunk, ChunkResult result);
  Status take(const Chunk& chunk);
  Status take_metadata(const Chunk& chunk);
  Status take_attribute(const Chunk& chunk);
  Status take_attribute_group(const Chunk& chunk);
  Status take_resource(const Chunk& chunk);
  Status take_bounds(const Chunk& chunk);
  Status take_reference(const Chunk& chunk);
  Status note_chunk(const Chunk& chunk, uint32_t frame_count);
  Status check_reference(const Chunk& chunk, const ReferenceChunk& reference) const;
  Status take_group(const Chunk& chunk);
  Status check_group(const Chunk& chunk, const GroupHeader& header) const;
  Status take_seek_table(const Chunk& chunk);
  Status check_complete();
  void count(const char* section, uint64_t bytes);
  bool open_ended() const { return (out_.header.flags & SequenceHeader::kOpenEnded) != 0; }
  bool intact() const { return out_.damaged.empty() && !out_.truncated; }
  uint64_t rest() const { return source_.size() - offset_; }
  uint64_t frames_end() const;

  ByteSource& source_;
  const Limits& limits_;
  Checksums checksums_;
  MemoryAccount& account_;
  ContainerReader& out_;
  Lease own_;                    // of what is in here
  std::vector<uint8_t> buffer_;  // of the last `fetch`
  Status status_;                // of the source, and of memory for damage; the first failure stays
  uint64_t offset_ = 0;
  std::vector<Landmark> landmarks_;  // ascending; the last is the seek chunk itself
  bool landmarks_sought_ = false;
  bool lost_ = false;            // no chunk starts at `offset_`, and the file is not complete yet
  std::vector<SeekEntry> seen_;  // what the seek table should say
  uint64_t seen_end_ = 0;
  bool has_preamble_ = false, has_header_ = false, seek_seen_ = false;
};

/// Room for one more, for which both the old and the new block are there for a moment.
template <class T>
Status ContainerParser::make_room(std::vector<T>& list, Lease& lease) {
  constexpr size_t kFirst = 8;
  const size_t before = list.capacity();
  if (list.size() < before) return {};
  const size_t after = std::max(kFirst, 2 * before);
  if (Status s = spend(after * sizeof(T), lease); !s.ok()) return s;
  list.reserve(after);
  lease.shrink(lease.bytes() - before * sizeof(T));
  return {};
}

}  // namespace reeb
