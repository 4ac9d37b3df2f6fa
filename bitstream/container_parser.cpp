#include "bitstream/container_parser.h"

#include <algorithm>

#include "bitstream/bytes.h"
#include "bitstream/crc32c.h"
#include "bitstream/element_bound.h"
#include "bitstream/syntax.h"

namespace reeb {
namespace {

constexpr size_t kMaxHeaderBytes = 512;     // headers of meshes and groups are shorter
constexpr size_t kBlock = size_t{1} << 16;  // read at once to check a sum

Status corrupt(const Chunk& chunk, const std::string& what) {
  return Status::corrupt(to_string(chunk.type) + " at byte " + std::to_string(chunk.offset) + ": " +
                         what);
}

template <class Header>
Status read_whole(const Chunk& chunk, Header& header) {
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, to_string(chunk.type), header); !s.ok()) return s;
  return in.position() == chunk.payload_size ? Status()
                                             : corrupt(chunk, "bytes after the last field");
}

bool is_trailer(std::span<const uint8_t> bytes) {
  return bytes.size() == kTrailerBytes &&
         std::equal(kEndMark.begin(), kEndMark.end(), bytes.begin() + 4);
}

bool read_whole_payload(const ChunkType& type) {
  return type == kMetadataChunk || type == kSeekChunk || type == kBoundsChunk;
}

}  // namespace

uint64_t ContainerParser::frames_end() const {
  if (out_.groups.empty()) return 0;
  const GroupHeader& last = out_.groups.back().header;
  return uint64_t{last.first_frame} + last.frame_count;
}

bool ContainerParser::fetch(uint64_t offset, uint64_t count, std::span<const uint8_t>& out) {
  if (status_.ok()) status_ = source_.read(offset, static_cast<size_t>(count), buffer_, out);
  return status_.ok();
}

// The payload of a mesh or a group comes without its sections.
ChunkResult ContainerParser::read(uint64_t offset, Chunk& chunk) {
  const uint64_t available = source_.size() - offset;
  std::span<const uint8_t> front;
  if (!fetch(offset, std::min<uint64_t>(available, kMaxFrontBytes), front))
    return ChunkResult::kCut;
  const ChunkResult result = read_chunk_front(front, offset, available, chunk);
  if (result != ChunkResult::kFound) return result;
  chunk.crc_ok = landmark_of(chunk) != nullptr || check_crc(chunk);
  if (!chunk.crc_ok) return result;
  const bool all = read_whole_payload(chunk.type);
  // `take` says so where that fails.
  if (all && !spend(chunk.payload_size, own_).ok()) return result;
  fetch(chunk.payload_offset,
        all ? chunk.payload_size : std::min<uint64_t>(chunk.payload_size, kMaxHeaderBytes),
        chunk.payload);
  return result;
}

bool ContainerParser::check_crc(const Chunk& chunk) {
  uint32_t sum = crc32c(chunk.type);
  std::span<const uint8_t> bytes;
  for (uint64_t done = 0; done < chunk.payload_size; done += bytes.size()) {
    const uint64_t count = std::min<uint64_t>(kBlock, chunk.payload_size - done);
    if (!fetch(chunk.payload_offset + done, count, bytes)) return false;
    sum = crc32c(bytes, sum);
  }
  if (!fetch(chunk.payload_offset + chunk.payload_size, 4, bytes)) return false;
  return ByteReader(bytes).u32() == sum;
}

// The entry that lets the checksum of a mesh or group wait; nullptr where it must be checked now.
const ContainerParser::Landmark* ContainerParser::landmark_of(const Chunk& chunk) const {
  if (checksums_ == Checksums::kNow) return nullptr;
  const auto before = [](const Landmark& l, uint64_t offset) { return l.offset < offset; };
  const auto at = std::lower_bound(landmarks_.begin(), landmarks_.end(), chunk.offset, before);
  if (at == landmarks_.end() || at->offset != chunk.offset || at->size != chunk.size)
    return nullptr;
  const ChunkType& wanted = at->frame_count == 0 ? kReferenceChunk : kGroupChunk;
  return chunk.type == wanted ? &*at : nullptr;
}

// Counts memory for what headers unfold to.
Status ContainerParser::spend(uint64_t bytes, Lease& lease) {
  return lease.grow(account_, bytes) ? Status()
                                     : Status::limit("the headers need more memory than allowed");
}

void ContainerParser::count(const char* section, uint64_t bytes) {
  const auto same = [&](const auto& s) { return s.first == section; };
  const auto at = std::find_if(out_.sections.begin(), out_.sections.end(), same);
  if (at == out_.sections.end()) {
    out_.sections.emplace_back(section, bytes);
  } else {
    at->second += bytes;
  }
}

Status ContainerParser::read_preamble(bool complete) {
  std::span<const uint8_t> front;
  if (!fetch(0, std::min<uint64_t>(source_.size(), kPreambleBytes), front)) return status_;
  const size_t letters = std::min(front.size(), kSignature.size());
  if (!std::equal(front.begin(), front.begin() + static_cast<ptrdiff_t>(letters),
                  kSignature.begin())) {
    return Status::corrupt("not a Reeb file: wrong signature");
  }
  if (front.size() < kPreambleBytes)
    return complete ? Status::truncated("the file ends in its signature") : Status();
  out_.format_version = front[kSignature.size()];
  if (out_.format_version != kFormatVersion) {
    return {StatusCode::kUnsupported,
            "format version " + std::to_string(out_.format_version) + " is not known"};
  }
  offset_ = kPreambleBytes;
  has_preamble_ = true;
  return {};
}

Status ContainerParser::read_sequence_header(bool complete) {
  Chunk chunk;
  const ChunkResult result = read(offset_, chunk);
  if (!status_.ok()) return status_;
  if (result == ChunkResult::kCut)
    return complete ? Status::truncated("the file ends in its HEAD chunk") : Status();
  if (result == ChunkResult::kNoChunk || chunk.type != kHeadChunk) {
    return Status::corrupt("the first chunk is not HEAD");
  }
  if (!chunk.crc_ok) return corrupt(chunk, "wrong checksum");
  if (Status s = read_whole(chunk, out_.header); !s.ok()) return s;
  if (!open_ended() && out_.header.total_frames > limits_.max_frames) {
    return Status::limit(std::to_string(out_.header.total_frames) + " frames, more than allowed");
  }
  offset_ += chunk.size;
  has_header_ = true;
  count("header", offset_);
  return {};
}

// The seek table as the trailer finds it; nothing where anything about it is wrong.
std::optional<Chunk> ContainerParser::find_seek_chunk() {
  const uint64_t size = source_.size();
  std::span<const uint8_t> trailer;
  if (size < kPreambleBytes + kTrailerBytes || !fetch(size - kTrailerBytes, kTrailerBytes, trailer))
    return {};
  if (!is_trailer(trailer)) return {};
  const uint32_t distance = ByteReader(trailer).u32();
  if (distance > size - kPreambleBytes || distance < kTrailerBytes) return {};
  Chunk chunk;
  const bool found = read(size - distance, chunk) == ChunkResult::kFound;
  const bool right = found && chunk.crc_ok && chunk.type == kSeekChunk && !chunk.payload.empty();
  return right && chunk.size + kTrailerBytes == distance ? std::optional(chunk) : std::nullopt;
}

// Entries that point outside the file are dropped: the table is a hint here, `take_seek_table`
// judges it.
void ContainerParser::find_landmarks() {
  landmarks_sought_ = true;
  const auto chunk = find_seek_chunk();
  SeekTable table;
  Lease lease;
  if (!chunk || !read_seek_table(*chunk, table, lease).ok()) return;
  const size_t most = table.entries.size() + 1;
  if (!spend(most * sizeof(Landmark), own_).ok()) return;
  landmarks_.reserve(most);
  uint64_t at = 0;
  for (const SeekEntry& entry : table.entries) {
    if (entry.gap > chunk->offset - at) break;
    at += entry.gap;
    landmarks_.push_back({at, entry.size, entry.frame_count});
    if (entry.size > chunk->offset - at) break;
    at += entry.size;
  }
  landmarks_.push_back({chunk->offset, chunk->size, 0});
}

// True when nothing but the trailer is left, or nothing at all.
bool ContainerParser::at_end() {
  std::span<const uint8_t> bytes;
  if (rest() == kTrailerBytes && fetch(offset_, kTrailerBytes, bytes) && is_trailer(bytes)) {
    if (!seek_seen_ || landmarks_.empty()) note_damage("", rest());
    count("seek table", rest());
    return true;
  }
  if (seek_seen_ && rest() >= kTrailerBytes) {  // no trailer where it should be
    note_damage("", rest());
    count("damaged", rest());
    return true;
  }
  if (rest() > 0 && !seek_seen_) return false;
  out_.truncated = true;
  count("damaged", rest());
  return true;
}

// Without memory for more of it, reading ends.
void ContainerParser::note_damage(const std::string& type, uint64_t size) {
  if (status_.ok()) status_ = make_room(out_.damaged, out_.lease);
  if (status_.ok()) out_.damaged.push_back({type, offset_, size});
}

// Goes to the next place where a chunk is known or claimed to start, else to the end of the file.
void ContainerParser::skip_damage(const Chunk& chunk, ChunkResult result) {
  const auto next =
      std::upper_bound(landmarks_.begin(), landmarks_.end(), offset_,
                       [](uint64_t offset, const Landmark& l) { return offset < l.offset; });
  uint64_t end = source_.size();
  const bool ancillary = result == ChunkResult::kFound && !is_critical(chunk.type);
  if (next != landmarks_.end()) {
    // Others that the table does not know may follow.
    end = ancillary ? std::min(next->offset, offset_ + chunk.size) : next->offset;
  } else if (result == ChunkResult::kFound) {
    end = offset_ + chunk.size;
  } else if (result == ChunkResult::kCut) {
    out_.truncated = true;
  }
  const bool typed = is_chunk_type(chunk.type);
  note_damage(typed ? to_string(chunk.type) : "", end - offset_);
  count("damaged", end - offset_);
  offset_ = end;
}

// Deals with a place where no whole chunk is; false where the rest of the file must come first.
bool ContainerParser::wait_or_skip(const Chunk& chunk, ChunkResult result, bool complete) {
  if (!complete && result != ChunkResult::kFound) {
    lost_ = result == ChunkResult::kNoChunk;
    return false;
  }
  skip_damage(chunk, result);
  return !out_.truncated;
}

Status ContainerParser::scan(bool complete) {
  while (complete ? !at_end() : !seek_seen_ && rest() > 0) {
    Chunk chunk;
    const ChunkResult result = read(offset_, chunk);
    Status taken;
    bool right = result == ChunkResult::kFound && chunk.crc_ok;
    if (right && status_.ok()) taken = take(chunk);
    // A chunk whose checksum was to wait and that makes no sense may be damaged.
    if (!taken.ok() && landmark_of(chunk) != nullptr) right = check_crc(chunk);
    if (!status_.ok()) return status_;
    if (right && !taken.ok()) return taken;
    if (right) {
      offset_ += chunk.size;
    } else if (!wait_or_skip(chunk, result, complete)) {
      break;
    }
  }
  return status_;
}

Status ContainerParser::take(const Chunk& chunk) {
  if (chunk.type == kReferenceChunk) return take_reference(chunk);
  if (chunk.type == kGroupChunk) return take_group(chunk);
  if (chunk.type == kSeekChunk) return take_seek_table(chunk);
  if (chunk.type == kMetadataChunk) return take_metadata(chunk);
  if (chunk.type == kAttributeChunk) return take_attribute(chunk);
  if (chunk.type == kAttributeGroupChunk) return take_attribute_group(chunk);
  if (chunk.type == kResourceChunk) return take_resource(chunk);
  if (chunk.type == kBoundsChunk) return take_bounds(chunk);
  if (chunk.type == kHeadChunk) return corrupt(chunk, "a second sequence header");
  if (is_critical(chunk.type)) {
    return {StatusCode::kUnsupported, "unknown critical chunk " + to_string(chunk.type)};
  }
  count("unknown", chunk.size);
  return {};
}

// `entries`: for the time that they are not in `out_`; their texts stay.
Status ContainerParser::read_metadata(const Chunk& chunk, Metadata& out, Lease& entries) {
  const uint64_t most = chunk.payload_size / 2;  // an entry has two bytes at least
  const uint64_t there = std::min(ByteReader(chunk.payload).varuint(), most);
  const uint64_t texts = text_memory(chunk.payload_size, 2 * there);
  if (Status s = spend(texts, out_.lease); !s.ok()) return s;
  if (Status s = spend(there * sizeof(MetadataEntry), entries); !s.ok()) return s;
  return read_whole(chunk, out);
}

Status ContainerParser::take_metadata(const Chunk& chunk) {
  Metadata more;
  Lease lease;
  if (Status s = read_metadata(chunk, more, lease); !s.ok()) return s;
  for (MetadataEntry& entry : more.entries) {
    if (Status s = make_room(out_.metadata, out_.lease); !s.ok()) return s;
    out_.metadata.push_back(std::move(entry));
  }
  count("metadata", chunk.size);
  return {};
}

Status ContainerParser::note_chunk(const Chunk& chunk, uint32_t frame_count) {
  if (Status s = make_room(seen_, own_); !s.ok()) return s;
  seen_.push_back({chunk.offset - seen_end_, chunk.size, frame_count});
  seen_end_ = chunk.offset + chunk.size;
  return {};
}

Status ContainerParser::check_reference(const Chunk& chunk, const ReferenceChunk& r) const {
  if (r.mesh_header.vertex_count > limits_.max_vertices) {
    return Status::limit(std::to_string(r.mesh_header.vertex_count) +
                         " vertices, more than allowed");
  }
  if (r.mesh_header.face_count > limits_.max_faces) {
    return Status::limit(std::to_string(r.mesh_header.face_count) + " faces, more than allowed");
  }
  const bool first = out_.references.empty();
  if (r.header.shot >= out_.header.shot_count) return corrupt(chunk, "shot is not announced");
  if (!first && r.header.shot <= out_.references.back().header.shot) {
    return corrupt(chunk, "shots out of order");
  }
  if (r.header.first_frame < frames_end() || r.header.first_frame >= out_.header.total_frames) {
    return corrupt(chunk, "first_frame is not after the frames before");
  }
  if (intact() &&
      (r.header.shot != out_.references.size() || r.header.first_frame != frames_end() ||
       (!first && r.header.first_frame == out_.references.back().header.first_frame))) {
    return corrupt(chunk, "shots are not consecutive");
  }
  return {};
}

Status ContainerParser::take_reference(const Chunk& chunk) {
  ReferenceChunk r;
  r.offset = chunk.offset;
  r.size = chunk.size;
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, "REFM", r.header); !s.ok()) return s;
  if (Status s = read_header(in, "mesh header", r.mesh_header); !s.ok()) return s;
  if (Status s = check_reference(chunk, r); !s.ok()) return s;
  if (Status s = make_room(out_.references, out_.lease); !s.ok()) return s;
  out_.references.push_back(r);
  count("reference mesh", chunk.size);
  return note_chunk(chunk, 0);
}

Status ContainerParser::check_group(const Chunk& chunk, const GroupHeader& h) const {
  if (open_ended() && uint64_t{h.first_frame} + h.frame_count > limits_.max_frames) {
    return Status::limit("more frames than allowed");
  }
  if (uint64_t{h.first_frame} + h.frame_count > out_.header.total_frames) {
    return corrupt(chunk, "frames past the end of the sequence");
  }
  if (h.first_frame < frames_end() || (intact() && h.first_frame != frames_end())) {
    return corrupt(chunk, "first_frame does not follow the group before");
  }
  if (h.shot >= out_.header.shot_count) return corrupt(chunk, "shot is not announced");
  if (!out_.groups.empty() && h.shot < out_.groups.back().header.shot) {
    return corrupt(chunk, "shots out of order");
  }
  const uint32_t newest = out_.references.empty() ? 0 : out_.references.back().header.shot;
  if ((intact() && out_.references.empty()) || h.shot < newest || (intact() && h.shot != newest)) {
    return corrupt(chunk, "no reference mesh of its shot before it");
  }
  return {};
}

Status ContainerParser::take_group(const Chunk& chunk) {
  GroupChunk g;
  g.offset = chunk.offset;
  g.size = chunk.size;
  ByteReader in(chunk.payload);
  const GroupHeader& h = g.header;
  if (Status s = read_header(in, "GRUP", g.header); !s.ok()) return s;
  if (in.position() + section_bytes(h) != chunk.payload_size)
    return corrupt(chunk, "sections do not fill the chunk");
  if (Status s = check_group(chunk, h); !s.ok()) return s;
  const Landmark* landmark = landmark_of(chunk);
  if (landmark != nullptr && landmark->frame_count != h.frame_count)
    return corrupt(chunk, "the seek table has another frame_count");
  if (Status s = make_room(out_.groups, out_.lease); !s.ok()) return s;
  out_.groups.push_back(g);
  for (const GroupSection& s : kGroupSections) {
    if (h.*s.bytes > 0) count(s.name, h.*s.bytes);
  }
  count("group headers", chunk.size - section_bytes(h));
  return note_chunk(chunk, h.frame_count);
}

Status ContainerParser::read_seek_table(const Chunk& chunk, SeekTable& out, Lease& lease) {
  const uint64_t most = chunk.payload_size / 3;  // an entry has three bytes at least
  const uint64_t there = std::min(ByteReader(chunk.payload).varuint(), most);
  if (Status s = spend(there * sizeof(SeekEntry), lease); !s.ok()) return s;
  return read_whole(chunk, out);
}

Status ContainerParser::take_seek_table(const Chunk& chunk) {
  SeekTable table;
  Lease lease;
  if (Status s = read_seek_table(chunk, table, lease); !s.ok()) return s;
  if (intact() && table.entries != seen_) return corrupt(chunk, "the table is wrong");
  seek_seen_ = true;
  count("seek table", chunk.size);
  return {};
}

Status ContainerParser::check_complete() {
  if (open_ended()) {
    if (intact() &&
        (out_.groups.empty() || out_.references.back().header.first_frame == frames_end())) {
      return Status::corrupt("the file ends with a shot without frames");
    }
    out_.header.total_frames = static_cast<uint32_t>(frames_end());
    out_.header.shot_count = static_cast<uint32_t>(out_.references.size());
    return {};
  }
  if (!intact()) return {};
  if (!out_.bounds.empty() && out_.bounds.size() != out_.groups.size())
    return Status::corrupt("bnds has not as many boxes as there are groups");
  if (out_.references.size() != out_.header.shot_count ||
      frames_end() != out_.header.total_frames) {
    return Status::corrupt("HEAD announces more shots or frames than the file holds");
  }
  return {};
}

// Reads a damaged file once more, now that its seek table may help.
Status ContainerParser::restart() {
  out_ = {};
  landmarks_ = {};
  seen_ = {};
  buffer_ = {};
  own_ = {};
  offset_ = seen_end_ = 0;
  landmarks_sought_ = lost_ = has_preamble_ = has_header_ = seek_seen_ = false;
  return advance(true);
}

Status ContainerParser::advance(bool complete) {
  if (complete && (lost_ || !out_.damaged.empty())) return restart();
  if (!has_preamble_) {
    if (Status s = read_preamble(complete); !s.ok()) return s;
    if (!has_preamble_) return {};
  }
  if (!has_header_) {
    if (Status s = read_sequence_header(complete); !s.ok()) return s;
    if (!has_header_) return {};
  }
  if (complete && !landmarks_sought_) find_landmarks();
  if (!lost_) {
    if (Status s = scan(complete); !s.ok()) return s;
  }
  return complete ? check_complete() : Status();
}

}  // namespace reeb
