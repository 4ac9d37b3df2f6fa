// Every field of every header, one at a time, at the ends of its range and beyond.
#include <catch2/catch.hpp>
#include <limits>
#include <set>

#include "bitstream/bytes.h"
#include "bitstream/chunk.h"
#include "bitstream/headers.h"
#include "bitstream/syntax.h"
#include "tests/codec/hostile.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Writes a header with one field, by its number, replaced by one of its extreme values.
class ExtremeWriter : public SyntaxVisitor<ExtremeWriter> {
 public:
  ExtremeWriter(size_t field, size_t choice) : field_(field), choice_(choice) {}

  void integer_field(const char* name, uint64_t& value, uint64_t lowest, uint64_t highest,
                     bool one_byte) {
    std::vector<uint64_t> extremes = {lowest, highest, lowest - 1, highest + 1, 0, UINT64_MAX};
    for (int bit = 0; bit < 64; bit += one_byte ? 1 : 21) extremes.push_back(uint64_t{1} << bit);
    replace(name, extremes, value);
    if (one_byte) {
      value &= 255;
      out.push_back(static_cast<uint8_t>(value));
    } else {
      append_varuint(out, value);
    }
  }
  void real(const char* name, double& value, double lowest, double highest, bool wide) {
    using Limit = std::numeric_limits<double>;
    replace(name,
            {lowest, highest, 2 * lowest, 2 * highest, 0, -0.0, -highest, Limit::quiet_NaN(),
             Limit::infinity(), -Limit::infinity(), Limit::denorm_min(), 1.5e-45},
            value);
    if (wide) {
      append_f64(out, value);
    } else {
      append_f32(out, static_cast<float>(value));
    }
  }
  void text_field(const char* name, std::string& value) {
    std::vector<uint64_t> lengths = {value.size(), 0, value.size() + 1, 1u << 31, UINT64_MAX};
    uint64_t length = value.size();
    replace(name, lengths, length);
    append_varuint(out, length);
    out.insert(out.end(), value.begin(), value.end());
  }
  size_t list_size(const char* name, size_t count, size_t) {
    uint64_t written = count;
    replace(name, {0, count + 1, count - 1, 1u << 31, UINT64_MAX}, written);
    append_varuint(out, written);
    return count;
  }
  void fail(const char*, std::string_view) {}

  Bytes out;
  std::string replaced;    ///< name of the field; empty past the last one
  bool exhausted = false;  ///< the field has no so many extreme values

 private:
  template <class T>
  void replace(const char* name, const std::vector<T>& extremes, T& value) {
    if (seen_++ != field_) return;
    replaced = name;
    exhausted = choice_ >= extremes.size();
    if (!exhausted) value = extremes[choice_];
  }

  size_t field_, choice_, seen_ = 0;
};

struct ChunkBytes {
  ChunkType type;
  Bytes payload;
};

std::vector<ChunkBytes> split(const Bytes& file) {
  std::vector<ChunkBytes> out;
  Chunk chunk;
  for (uint64_t at = kPreambleBytes; at + kTrailerBytes < file.size(); at += chunk.size) {
    REQUIRE(read_chunk(file, at, chunk) == ChunkResult::kFound);
    out.push_back({chunk.type, Bytes(chunk.payload.begin(), chunk.payload.end())});
  }
  return out;
}

/// The file of these chunks, with the sizes that they have now in the seek table unless that is
/// what was changed.
Bytes join(const Bytes& original, const std::vector<ChunkBytes>& chunks, bool keep_table) {
  Bytes out(original.begin(), original.begin() + kPreambleBytes);
  ByteReader in(chunks.back().payload);
  SeekTable table;
  if (!keep_table) REQUIRE(read_header(in, "seek", table).ok());
  size_t entry = 0, table_begin = 0;
  for (const ChunkBytes& chunk : chunks) {
    const size_t begin = table_begin = out.size();
    Bytes payload = chunk.payload;
    if (chunk.type == kSeekChunk && !keep_table) {
      payload.clear();
      REQUIRE(write_header(table, "seek", payload).ok());
    }
    append_chunk(out, chunk.type, payload);
    const bool listed = chunk.type == kReferenceChunk || chunk.type == kGroupChunk;
    if (listed && !keep_table) table.entries[entry++].size = out.size() - begin;
  }
  append_u32(out, static_cast<uint32_t>(out.size() + kTrailerBytes - table_begin));
  out.insert(out.end(), kEndMark.begin(), kEndMark.end());
  return out;
}

template <class Header>
void skip_header(ByteReader& in) {
  Header header;
  REQUIRE(read_header(in, "front", header).ok());
}

/// Runs all extremes of the header that the first chunk of a type has, behind those named by
/// `Front`.
template <class Header, class... Front>
void try_extremes(const Bytes& file, const ChunkType& type, std::set<std::string>& tried) {
  std::vector<ChunkBytes> chunks = split(file);
  size_t first = 0;
  while (chunks[first].type != type) ++first;
  const Bytes payload = chunks[first].payload;
  ByteReader in(payload);
  (skip_header<Front>(in), ...);
  const auto begin = static_cast<std::ptrdiff_t>(in.position());
  Header header;
  REQUIRE(read_header(in, "header", header).ok());
  const auto end = static_cast<std::ptrdiff_t>(in.position());
  for (size_t field = 0;; ++field) {
    for (size_t choice = 0;; ++choice) {
      ExtremeWriter writer(field, choice);
      Header changed = header;
      describe(writer, changed);
      if (writer.replaced.empty()) return;
      if (writer.exhausted) break;
      INFO(writer.replaced << ", choice " << choice);
      tried.insert(writer.replaced);
      Bytes& out = chunks[first].payload;
      out.assign(payload.begin(), payload.begin() + begin);
      out.insert(out.end(), writer.out.begin(), writer.out.end());
      out.insert(out.end(), payload.begin() + end, payload.end());
      const Outcome outcome = metered_probe(join(file, chunks, type == kSeekChunk), tight_limits());
      CHECK(outcome.frames <= 20);
    }
  }
}

}  // namespace

TEST_CASE("the unchanged header decodes", "[hostile]") {
  for (const StreamKind& kind : stream_kinds()) {
    INFO(kind.name);
    CHECK(join(kind.bytes, split(kind.bytes), false) == kind.bytes);
    CHECK(probe(kind.bytes, tight_limits()).frames == 8);
  }
}

TEST_CASE("every header field at its extremes is decoded or refused", "[hostile]") {
  std::set<std::string> tried;
  for (const StreamKind& kind : stream_kinds()) {
    INFO(kind.name);
    try_extremes<SequenceHeader>(kind.bytes, kHeadChunk, tried);
    try_extremes<ReferenceHeader>(kind.bytes, kReferenceChunk, tried);
    try_extremes<MeshHeader, ReferenceHeader>(kind.bytes, kReferenceChunk, tried);
    try_extremes<GroupHeader>(kind.bytes, kGroupChunk, tried);
    try_extremes<Metadata>(kind.bytes, kMetadataChunk, tried);
    try_extremes<SeekTable>(kind.bytes, kSeekChunk, tried);
  }
  // Fields that only some streams have.
  for (const char* name : {"position_bytes", "face_bytes", "axis_step_y", "region_count",
                           "motion_bytes", "correction_step", "correction_count", "entry_count"}) {
    INFO(name);
    CHECK(tried.count(name) == 1);
  }
}
