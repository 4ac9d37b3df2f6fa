#include "codec/dec/stream_info.h"

#include <algorithm>

namespace reeb {

namespace {

void add_shot(const ReferenceChunk& r, StreamInfo& info) {
  const bool kept = (r.mesh_header.flags & MeshHeader::kOrderKept) != 0;
  info.shots.push_back(
      {r.header.first_frame, 0, r.mesh_header.vertex_count, r.mesh_header.face_count, kept});
}

/// A group that continues one that is damaged, cut off or of another shot is lost with it.
bool is_whole(const GroupChunk& g, const StreamInfo& info) {
  if (!g.continues()) return true;
  if (info.groups.empty() || info.groups.back().shot != g.header.shot) return false;
  const StreamInfo::Group& before = info.groups.back();
  return before.first_frame + before.frame_count == g.header.first_frame;
}

void add_group(const ContainerReader& container, const GroupChunk& g, StreamInfo& info) {
  const GroupHeader& h = g.header;
  info.groups.push_back({h.first_frame, h.frame_count, h.shot, h.region_count, h.component_count,
                         g.size, g.continues(), h.profile, h.stored_count});
  if (const ReferenceChunk* r = container.reference(h.shot)) {
    info.shots[static_cast<size_t>(r - container.references.data())].frame_count += h.frame_count;
  }
  info.frame_count = std::max(info.frame_count, h.first_frame + h.frame_count);
}

void add_gap(uint32_t first, uint32_t end, std::vector<StreamInfo::Gap>& gaps) {
  if (first >= end) return;
  if (!gaps.empty() && gaps.back().first_frame + gaps.back().frame_count == first) {
    gaps.back().frame_count += end - first;
  } else {
    gaps.push_back({first, end - first});
  }
}

std::vector<StreamInfo::Gap> find_gaps(const ContainerReader& container, const StreamInfo& info) {
  std::vector<StreamInfo::Gap> gaps;
  uint32_t next = 0;
  for (const StreamInfo::Group& g : info.groups) {
    const uint32_t end = g.first_frame + g.frame_count;
    const bool usable = container.reference(g.shot) != nullptr;
    add_gap(next, usable ? g.first_frame : end, gaps);
    next = end;
  }
  add_gap(next, container.header.total_frames, gaps);
  return gaps;
}

// These are few, so that they are told anew each time. Like those of the container, they rise by
// shot and index.
void tell_attributes(const ContainerReader& container, StreamInfo& info) {
  info.attributes.clear();
  info.resources.clear();
  for (const AttributeChunk& a : container.attributes)
    info.attributes.push_back({a.header, a.size});
  for (const AttributeGroupChunk& g : container.attribute_groups) {
    const AttributeChunk* a = container.attribute(g.header.shot, g.header.index);
    if (a != nullptr)
      info.attributes[static_cast<size_t>(a - container.attributes.data())].bytes += g.size;
  }
  for (const ResourceChunk& r : container.resources) info.resources.push_back({r.header, r.size});
  const bool all = container.bounds.size() == info.groups.size();
  info.bounds = all ? container.bounds : std::vector<Box>();
  info.damaged = container.damaged;
}

}  // namespace

// A list that grows has its old block beside the new one, which is twice as large.
uint64_t info_memory(const ContainerReader& c) {
  constexpr uint64_t kGrowing = 3, kReplaced = 2;
  uint64_t texts = 0;
  for (const MetadataEntry& m : c.metadata) texts += text_memory(m.key) + text_memory(m.value);
  for (const AttributeChunk& a : c.attributes) texts += text_memory(a.header.name);
  for (const ResourceChunk& r : c.resources)
    texts += text_memory(r.header.name) + text_memory(r.header.media_type);
  const uint64_t growing = c.references.size() * sizeof(StreamInfo::ShotInfo) +
                           c.groups.size() * sizeof(StreamInfo::Group) +
                           c.metadata.size() * sizeof(StreamInfo::metadata[0]) +
                           c.attributes.size() * sizeof(StreamInfo::AttributeInfo) +
                           c.resources.size() * sizeof(StreamInfo::ResourceInfo) +
                           (c.groups.size() + 1) * sizeof(StreamInfo::Gap);
  const uint64_t replaced = c.bounds.size() * sizeof(Box) + c.damaged.size() * sizeof(DamagedRange);
  return sizeof(StreamInfo) + texts + kGrowing * growing + kReplaced * replaced;
}

void update_info(const ContainerReader& container, uint64_t file_bytes, bool complete,
                 size_t first_group, StreamInfo& info) {
  info.format_version = container.format_version;
  info.frame_rate = container.header.frame_rate;
  info.start_time = container.header.start_time;
  info.total_frames = container.header.total_frames;
  info.truncated = container.truncated;
  info.file_bytes = file_bytes;
  for (size_t i = info.shots.size(); i < container.references.size(); ++i)
    add_shot(container.references[i], info);
  for (size_t i = first_group; i < container.groups.size(); ++i) {
    if (is_whole(container.groups[i], info)) add_group(container, container.groups[i], info);
  }
  for (size_t i = info.metadata.size(); i < container.metadata.size(); ++i)
    info.metadata.emplace_back(container.metadata[i].key, container.metadata[i].value);
  tell_attributes(container, info);
  info.sections.clear();
  for (const auto& [name, bytes] : container.sections) info.sections.push_back({name, bytes});
  if (complete) info.missing = find_gaps(container, info);
}

}  // namespace reeb
