#include "bitstream/bytes.h"
#include "bitstream/container.h"
#include "bitstream/group_payload.h"
#include "bitstream/syntax.h"

namespace reeb {

namespace {

GroupHeader with_lengths(const GroupHeader& header, const GroupSections& sections) {
  GroupHeader sized = header;
  for (const GroupSection& s : kGroupSections) sized.*s.bytes = (sections.*s.data).size();
  return sized;
}

}  // namespace

Status write_group_payload(const GroupHeader& header, const GroupSections& sections,
                           std::vector<uint8_t>& out) {
  if (Status s = write_header(with_lengths(header, sections), "GRUP", out); !s.ok()) return s;
  for (const GroupSection& s : kGroupSections) {
    const std::span<const uint8_t> part = sections.*s.data;
    out.insert(out.end(), part.begin(), part.end());
  }
  return {};
}

Status ContainerWriter::begin(const SequenceHeader& header) {
  if (!out_.empty()) return Status::invalid("container: the output is not empty");
  std::vector<uint8_t> front;
  if (Status s = write_header(header, "HEAD", front); !s.ok()) return s;
  out_.insert(out_.end(), kSignature.begin(), kSignature.end());
  out_.push_back(kFormatVersion);
  append_chunk(out_, kHeadChunk, front);
  return {};
}

Status ContainerWriter::metadata(const std::vector<MetadataEntry>& entries) {
  if (entries.empty()) return {};
  std::vector<uint8_t> front;
  if (Status s = write_header(Metadata{entries}, "meta", front); !s.ok()) return s;
  append_chunk(out_, kMetadataChunk, front);
  return {};
}

void ContainerWriter::note_chunk(uint64_t start, uint32_t frame_count) {
  table_.entries.push_back({start - noted_end_, offset() - start, frame_count});
  noted_end_ = offset();
}

Status ContainerWriter::reference(const ReferenceHeader& header, std::span<const uint8_t> mesh) {
  std::vector<uint8_t> front;
  if (Status s = write_header(header, "REFM", front); !s.ok()) return s;
  const uint64_t start = offset();
  append_chunk(out_, kReferenceChunk, front, std::span(&mesh, 1));
  note_chunk(start, 0);
  return {};
}

Status ContainerWriter::group(const GroupHeader& header, const GroupSections& sections) {
  const GroupHeader sized = with_lengths(header, sections);
  std::array<std::span<const uint8_t>, std::size(kGroupSections)> parts;
  for (size_t i = 0; i < parts.size(); ++i) parts[i] = sections.*kGroupSections[i].data;
  std::vector<uint8_t> front;
  if (Status s = write_header(sized, "GRUP", front); !s.ok()) return s;
  const uint64_t start = offset();
  append_chunk(out_, kGroupChunk, front, parts);
  note_chunk(start, header.frame_count);
  return {};
}

Status ContainerWriter::attribute(const AttributeHeader& header, const AttributeBody& body,
                                  std::span<const uint8_t> values) {
  std::vector<uint8_t> front;
  if (Status s = write_header(header, "attr", front); !s.ok()) return s;
  if (Status s = write_header(body, "attr", front); !s.ok()) return s;
  append_chunk(out_, kAttributeChunk, front, std::span(&values, 1));
  return {};
}

Status ContainerWriter::attribute_group(const AttributeGroupHeader& header,
                                        std::span<const uint8_t> sections) {
  std::vector<uint8_t> front;
  if (Status s = write_header(header, "agrp", front); !s.ok()) return s;
  append_chunk(out_, kAttributeGroupChunk, front, std::span(&sections, 1));
  return {};
}

Status ContainerWriter::resource(const ResourceHeader& header, std::span<const uint8_t> bytes) {
  std::vector<uint8_t> front;
  if (Status s = write_header(header, "rsrc", front); !s.ok()) return s;
  append_chunk(out_, kResourceChunk, front, std::span(&bytes, 1));
  return {};
}

Status ContainerWriter::bounds(const GroupBoxes& bounds) {
  std::vector<uint8_t> front;
  if (Status s = write_header(bounds, "bnds", front); !s.ok()) return s;
  append_chunk(out_, kBoundsChunk, front);
  return {};
}

Status ContainerWriter::finish() {
  std::vector<uint8_t> front;
  if (Status s = write_header(table_, "seek", front); !s.ok()) return s;
  const uint64_t start = offset();
  append_chunk(out_, kSeekChunk, front);
  append_u32(out_, static_cast<uint32_t>(offset() + kTrailerBytes - start));
  out_.insert(out_.end(), kEndMark.begin(), kEndMark.end());
  return {};
}

void ContainerWriter::flush() {
  flushed_ += out_.size();
  out_.clear();
}

}  // namespace reeb
