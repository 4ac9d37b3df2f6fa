#include <algorithm>
#include <optional>

#include "bitstream/bytes.h"
#include "bitstream/container.h"
#include "bitstream/syntax.h"

namespace reeb {
namespace {

Status corrupt(const Chunk& chunk, const std::string& what) {
  return Status::corrupt(to_string(chunk.type) + " at byte " + std::to_string(chunk.offset) + ": " +
                         what);
}

template <class Header>
Status read_whole(const Chunk& chunk, Header& header) {
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, to_string(chunk.type), header); !s.ok()) return s;
  return in.remaining() == 0 ? Status() : corrupt(chunk, "bytes after the last field");
}

bool is_trailer(std::span<const uint8_t> bytes) {
  return bytes.size() == kTrailerBytes &&
         std::equal(kEndMark.begin(), kEndMark.end(), bytes.begin() + 4);
}

// The seek table as the trailer finds it; nothing where anything about it is wrong.
std::optional<Chunk> find_seek_chunk(std::span<const uint8_t> file) {
  if (file.size() < kPreambleBytes + kTrailerBytes) return {};
  const auto trailer = file.last(kTrailerBytes);
  if (!is_trailer(trailer)) return {};
  const uint32_t distance = ByteReader(trailer).u32();
  if (distance > file.size() - kPreambleBytes || distance < kTrailerBytes) return {};
  Chunk chunk;
  const bool found = read_chunk(file, file.size() - distance, chunk) == ChunkResult::kFound;
  const bool right = found && chunk.crc_ok && chunk.type == kSeekChunk;
  return right && chunk.size + kTrailerBytes == distance ? std::optional(chunk) : std::nullopt;
}

class Parser {
 public:
  Parser(std::span<const uint8_t> file, const Limits& limits, ContainerReader& out)
      : file_(file), limits_(limits), out_(out) {}

  Status run();

 private:
  Status read_preamble();
  Status read_sequence_header();
  void find_landmarks();
  Status scan();
  bool at_end();
  void skip_damage(const Chunk& chunk, ChunkResult result);
  Status take(const Chunk& chunk);
  Status take_reference(const Chunk& chunk);
  Status check_reference(const Chunk& chunk, const ReferenceChunk& reference) const;
  Status take_group(const Chunk& chunk);
  Status check_group(const Chunk& chunk, const GroupHeader& header) const;
  Status take_seek_table(const Chunk& chunk);
  Status check_complete();
  void count(const char* section, uint64_t bytes);
  bool open_ended() const { return (out_.header.flags & SequenceHeader::kOpenEnded) != 0; }
  bool intact() const { return out_.damaged.empty() && !out_.truncated; }
  uint64_t frames_end() const {
    if (out_.groups.empty()) return 0;
    const GroupHeader& last = out_.groups.back().header;
    return uint64_t{last.first_frame} + last.frame_count;
  }

  std::span<const uint8_t> file_;
  const Limits& limits_;
  ContainerReader& out_;
  uint64_t offset_ = 0;
  std::vector<uint64_t> landmarks_;  // where chunks start, by the seek table; ascending
  std::vector<SeekEntry> seen_;      // what the seek table should say
  uint64_t seen_end_ = 0;
  bool seek_seen_ = false;
};

void Parser::count(const char* section, uint64_t bytes) {
  const auto same = [&](const auto& s) { return s.first == section; };
  const auto at = std::find_if(out_.sections.begin(), out_.sections.end(), same);
  if (at == out_.sections.end()) {
    out_.sections.emplace_back(section, bytes);
  } else {
    at->second += bytes;
  }
}

Status Parser::read_preamble() {
  const auto front = file_.first(std::min(file_.size(), kSignature.size()));
  if (!std::equal(front.begin(), front.end(), kSignature.begin())) {
    return Status::corrupt("not a Reeb file: wrong signature");
  }
  if (file_.size() < kPreambleBytes) return Status::truncated("the file ends in its signature");
  out_.format_version = file_[kSignature.size()];
  if (out_.format_version != kFormatVersion) {
    return {StatusCode::kUnsupported,
            "format version " + std::to_string(out_.format_version) + " is not known"};
  }
  offset_ = kPreambleBytes;
  return {};
}

Status Parser::read_sequence_header() {
  Chunk chunk;
  const ChunkResult result = read_chunk(file_, offset_, chunk);
  if (result == ChunkResult::kCut) return Status::truncated("the file ends in its HEAD chunk");
  if (result == ChunkResult::kNoChunk || chunk.type != kHeadChunk) {
    return Status::corrupt("the first chunk is not HEAD");
  }
  if (!chunk.crc_ok) return corrupt(chunk, "wrong checksum");
  if (Status s = read_whole(chunk, out_.header); !s.ok()) return s;
  if (!open_ended() && out_.header.total_frames > limits_.max_frames) {
    return Status::limit(std::to_string(out_.header.total_frames) + " frames, more than allowed");
  }
  offset_ += chunk.size;
  count("header", offset_);
  return {};
}

// Entries that point outside the file are dropped: the table is a hint here, `take_seek_table`
// judges it.
void Parser::find_landmarks() {
  const auto chunk = find_seek_chunk(file_);
  SeekTable table;
  if (!chunk || !read_whole(*chunk, table).ok()) return;
  uint64_t at = 0;
  for (const SeekEntry& entry : table.entries) {
    if (entry.gap > chunk->offset - at) break;
    at += entry.gap;
    landmarks_.push_back(at);
    if (entry.size > chunk->offset - at) break;
    at += entry.size;
  }
  landmarks_.push_back(chunk->offset);
}

// True when nothing but the trailer is left, or nothing at all.
bool Parser::at_end() {
  const auto rest = file_.subspan(static_cast<size_t>(offset_));
  if (is_trailer(rest)) {
    if (!seek_seen_ || find_seek_chunk(file_) == std::nullopt) {
      out_.damaged.push_back({"", offset_, rest.size()});
    }
    count("seek table", rest.size());
    return true;
  }
  if (seek_seen_ && rest.size() >= kTrailerBytes) {  // no trailer where it should be
    out_.damaged.push_back({"", offset_, rest.size()});
    count("damaged", rest.size());
    return true;
  }
  if (!rest.empty() && !seek_seen_) return false;
  out_.truncated = true;
  count("damaged", rest.size());
  return true;
}

// Goes to the next place where a chunk is known or claimed to start, else to the end of the file.
void Parser::skip_damage(const Chunk& chunk, ChunkResult result) {
  const auto next = std::upper_bound(landmarks_.begin(), landmarks_.end(), offset_);
  uint64_t end = file_.size();
  if (next != landmarks_.end()) {
    end = *next;
  } else if (result == ChunkResult::kFound) {
    end = offset_ + chunk.size;
  } else if (result == ChunkResult::kCut) {
    out_.truncated = true;
  }
  const bool typed = is_chunk_type(chunk.type);
  out_.damaged.push_back({typed ? to_string(chunk.type) : "", offset_, end - offset_});
  count("damaged", end - offset_);
  offset_ = end;
}

Status Parser::scan() {
  while (!at_end()) {
    Chunk chunk;
    const ChunkResult result = read_chunk(file_, offset_, chunk);
    if (result != ChunkResult::kFound || !chunk.crc_ok) {
      skip_damage(chunk, result);
      if (out_.truncated) break;
      continue;
    }
    if (Status s = take(chunk); !s.ok()) return s;
    offset_ += chunk.size;
  }
  return {};
}

Status Parser::take(const Chunk& chunk) {
  if (chunk.type == kReferenceChunk) return take_reference(chunk);
  if (chunk.type == kGroupChunk) return take_group(chunk);
  if (chunk.type == kSeekChunk) return take_seek_table(chunk);
  if (chunk.type == kMetadataChunk) {
    Metadata more;
    if (Status s = read_whole(chunk, more); !s.ok()) return s;
    std::move(more.entries.begin(), more.entries.end(), std::back_inserter(out_.metadata));
    count("metadata", chunk.size);
    return {};
  }
  if (chunk.type == kHeadChunk) return corrupt(chunk, "a second sequence header");
  if (is_critical(chunk.type)) {
    return {StatusCode::kUnsupported, "unknown critical chunk " + to_string(chunk.type)};
  }
  count("unknown", chunk.size);
  return {};
}

Status Parser::check_reference(const Chunk& chunk, const ReferenceChunk& r) const {
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
  if (r.mesh_header.vertex_count > limits_.max_vertices) {
    return Status::limit(std::to_string(r.mesh_header.vertex_count) +
                         " vertices, more than allowed");
  }
  if (r.mesh_header.face_count > limits_.max_faces) {
    return Status::limit(std::to_string(r.mesh_header.face_count) + " faces, more than allowed");
  }
  return {};
}

Status Parser::take_reference(const Chunk& chunk) {
  ReferenceChunk r;
  r.offset = chunk.offset;
  r.size = chunk.size;
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, "REFM", r.header); !s.ok()) return s;
  r.mesh = chunk.payload.subspan(in.position());
  ByteReader mesh_in(r.mesh);
  if (Status s = read_header(mesh_in, "mesh header", r.mesh_header); !s.ok()) return s;
  if (Status s = check_reference(chunk, r); !s.ok()) return s;
  out_.references.push_back(r);
  seen_.push_back({chunk.offset - seen_end_, chunk.size, 0});
  seen_end_ = chunk.offset + chunk.size;
  count("reference mesh", chunk.size);
  return {};
}

Status Parser::check_group(const Chunk& chunk, const GroupHeader& h) const {
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

Status Parser::take_group(const Chunk& chunk) {
  GroupChunk g;
  g.offset = chunk.offset;
  g.size = chunk.size;
  ByteReader in(chunk.payload);
  if (Status s = read_header(in, "GRUP", g.header); !s.ok()) return s;
  g.motion = in.take(g.header.motion_bytes);
  g.coefficients = in.take(g.header.coefficient_bytes);
  g.basis = in.take(g.header.basis_bytes);
  g.corrections = in.take(g.header.correction_bytes);
  if (!in.ok() || in.remaining() != 0) return corrupt(chunk, "sections do not fill the chunk");
  if (Status s = check_group(chunk, g.header); !s.ok()) return s;
  out_.groups.push_back(g);
  seen_.push_back({chunk.offset - seen_end_, chunk.size, g.header.frame_count});
  seen_end_ = chunk.offset + chunk.size;
  count("motion", g.motion.size());
  count("coefficients", g.coefficients.size());
  count("basis", g.basis.size());
  count("corrections", g.corrections.size());
  count("group headers", chunk.size - g.motion.size() - g.coefficients.size() - g.basis.size() -
                             g.corrections.size());
  return {};
}

Status Parser::take_seek_table(const Chunk& chunk) {
  SeekTable table;
  if (Status s = read_whole(chunk, table); !s.ok()) return s;
  if (intact() && table.entries != seen_) return corrupt(chunk, "the table is wrong");
  seek_seen_ = true;
  count("seek table", chunk.size);
  return {};
}

Status Parser::check_complete() {
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
  if (out_.references.size() != out_.header.shot_count ||
      frames_end() != out_.header.total_frames) {
    return Status::corrupt("HEAD announces more shots or frames than the file holds");
  }
  return {};
}

Status Parser::run() {
  if (Status s = read_preamble(); !s.ok()) return s;
  if (Status s = read_sequence_header(); !s.ok()) return s;
  find_landmarks();
  if (Status s = scan(); !s.ok()) return s;
  return check_complete();
}

}  // namespace

Status ContainerReader::parse(std::span<const uint8_t> file, const Limits& limits) {
  *this = {};
  return Parser(file, limits, *this).run();
}

const ReferenceChunk* ContainerReader::reference(uint32_t shot) const {
  const auto before = [](const ReferenceChunk& r, uint32_t s) { return r.header.shot < s; };
  const auto at = std::lower_bound(references.begin(), references.end(), shot, before);
  return at == references.end() || at->header.shot != shot ? nullptr : &*at;
}

}  // namespace reeb
