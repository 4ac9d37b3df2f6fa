#include "codec/dec/decoder.h"

#include <algorithm>
#include <map>
#include <utility>

#include "bitstream/container.h"
#include "codec/common/correction_field.h"
#include "codec/common/motion_model.h"
#include "codec/common/parallel.h"
#include "codec/dec/group_decoder.h"
#include "codec/dec/reference_decoder.h"

namespace reeb {

namespace {

constexpr uint64_t kBytesPerRow =
    2600;  ///< of weights, graph and contexts of a field while it is decoded

/// Bytes that decoding a group takes at most.
uint64_t group_memory(uint64_t vertices, const GroupHeader& h) {
  if (h.profile == Profile::kLossless) {
    return vertices * (kBytesPerRow + 12 * uint64_t{h.component_count}) +
           uint64_t{h.frame_count} * sizeof(uint32_t);
  }
  const uint64_t components = h.component_count;
  const uint64_t surface = vertices * (kBytesPerRow + 4 * components);
  // The basis is there as it was decoded, by component and by frame.
  const uint64_t basis = 3 * uint64_t{h.frame_count} * (kBytesPerRow + 12 * (components + 1));
  const uint64_t motion = components * (sizeof(std::vector<MotionModel::Transform>) +
                                        uint64_t{h.region_count} * sizeof(MotionModel::Transform));
  const bool corrected = h.correction_count > 0;
  const uint64_t corrections = corrected ? CorrectionField::memory(vertices, h.frame_count) +
                                               2 * Corrections::kEntryBytes * h.correction_count
                                         : 0;
  return surface + basis + motion + corrections;
}

/// A group that continues one that is damaged, cut off or of another shot is lost with it.
void drop_broken_runs(std::vector<GroupChunk>& groups) {
  std::vector<GroupChunk> whole;
  for (const GroupChunk& g : groups) {
    if (g.continues()) {
      if (whole.empty() || whole.back().header.shot != g.header.shot) continue;
      const GroupHeader& before = whole.back().header;
      if (before.first_frame + before.frame_count != g.header.first_frame) continue;
    }
    whole.push_back(g);
  }
  groups = std::move(whole);
}

uint64_t connectivity_memory(const Connectivity& c) {
  return sizeof(uint32_t) * (c.face_sizes.size() + c.corners.size());
}

StreamInfo make_info(const ContainerReader& container, uint64_t file_bytes) {
  StreamInfo info;
  info.format_version = container.format_version;
  info.frame_rate = container.header.frame_rate;
  info.start_time = container.header.start_time;
  info.total_frames = container.header.total_frames;
  info.truncated = container.truncated;
  info.file_bytes = file_bytes;
  for (const ReferenceChunk& r : container.references) {
    const bool kept = (r.mesh_header.flags & MeshHeader::kOrderKept) != 0;
    info.shots.push_back(
        {r.header.first_frame, 0, r.mesh_header.vertex_count, r.mesh_header.face_count, kept});
  }
  for (const GroupChunk& g : container.groups) {
    const GroupHeader& h = g.header;
    info.groups.push_back({h.first_frame, h.frame_count, h.shot, h.region_count, h.component_count,
                           g.size, g.continues(), h.profile == Profile::kLossless});
    if (const ReferenceChunk* r = container.reference(h.shot)) {
      info.shots[static_cast<size_t>(r - container.references.data())].frame_count += h.frame_count;
    }
    info.frame_count = std::max(info.frame_count, h.first_frame + h.frame_count);
  }
  for (const auto& [name, bytes] : container.sections) info.sections.push_back({name, bytes});
  for (const MetadataEntry& m : container.metadata) info.metadata.emplace_back(m.key, m.value);
  return info;
}

}  // namespace

struct Decoder::Impl {
  ContainerReader container;
  DecodeOptions options;
  StreamInfo info;
  std::map<uint32_t, Connectivity> connectivities;  ///< of the shots met so far, for good
  uint64_t held = 0;                                ///< bytes of them
  uint32_t surface_shot = UINT32_MAX;               ///< shot of `surface`
  DecodedSurface surface;
  size_t open_group = SIZE_MAX;  ///< group of `synthesis`, always of `surface_shot`
  GroupSynthesis synthesis;
  GroupState state;  ///< what `state_group` left
  size_t state_group = SIZE_MAX;

  bool continued(size_t group) const;
  Status find_start(size_t group, size_t& first) const;
  Status find_group(uint32_t frame, size_t& index) const;
  Status open_shot(uint32_t shot);
  Status open(size_t group);
  Status check_memory(uint64_t bytes) const;
};

Status Decoder::Impl::find_group(uint32_t frame, size_t& index) const {
  const std::string name = "frame " + std::to_string(frame + 1);
  if (frame >= container.header.total_frames) return Status::invalid(name + " is past the end");
  const auto& groups = container.groups;
  const auto after =
      std::upper_bound(groups.begin(), groups.end(), frame,
                       [](uint32_t f, const GroupChunk& g) { return f < g.header.first_frame; });
  if (after == groups.begin() ||
      frame - std::prev(after)->header.first_frame >= std::prev(after)->header.frame_count) {
    return Status::corrupt(name + " is missing: its group is damaged or cut off");
  }
  index = static_cast<size_t>(std::prev(after) - groups.begin());
  return {};
}

Status Decoder::Impl::check_memory(uint64_t bytes) const {
  if (held + bytes <= options.limits.max_memory) return {};
  return Status::limit("the stream needs more memory than the limit allows");
}

Status Decoder::Impl::open_shot(uint32_t shot) {
  if (shot == surface_shot) return {};
  const ReferenceChunk* chunk = container.reference(shot);
  if (chunk == nullptr)
    return Status::corrupt("reference mesh " + std::to_string(shot + 1) + " is missing or damaged");
  if (Status s = check_memory(chunk->mesh_header.vertex_count * kBytesPerRow); !s.ok()) return s;
  surface_shot = UINT32_MAX;
  open_group = state_group = SIZE_MAX;
  state = {};
  ReferenceMesh mesh;
  if (Status s = decode_reference(chunk->mesh, options.limits, mesh); !s.ok()) return s;
  surface.grid = std::move(mesh.grid);
  surface.surface = build_surface_graph(GridPoints(surface.grid), mesh.triangles);
  surface.output.clear();
  for (const uint32_t v : surface.surface.order) surface.output.push_back(mesh.output_index[v]);
  std::copy(std::begin(chunk->header.origin), std::end(chunk->header.origin), surface.origin);
  surface.grid_step = chunk->header.grid_step;
  surface_shot = shot;
  const auto [at, added] = connectivities.try_emplace(shot, std::move(mesh.connectivity));
  if (added) held += connectivity_memory(at->second);
  return {};
}

/// True where the next group continues this one.
bool Decoder::Impl::continued(size_t group) const {
  return group + 1 < container.groups.size() && container.groups[group + 1].continues();
}

/// The group that decoding has to start with to have `group`.
Status Decoder::Impl::find_start(size_t group, size_t& first) const {
  for (first = group; container.groups[first].continues(); --first) {
    if (group - first == kMostOpenGroups) {
      return Status::corrupt("too many groups in a row continue each other");
    }
  }
  if (first <= state_group && state_group < group) first = state_group + 1;
  return {};
}

Status Decoder::Impl::open(size_t group) {
  if (group == open_group) return {};
  if (Status s = open_shot(container.groups[group].header.shot); !s.ok()) return s;
  size_t first = group;
  if (Status s = find_start(group, first); !s.ok()) return s;
  open_group = SIZE_MAX;
  for (size_t i = first; i <= group; ++i) {
    const GroupChunk& chunk = container.groups[i];
    if (Status s = check_memory(group_memory(surface.output.size(), chunk.header)); !s.ok())
      return s;
    const bool keep = continued(i);
    state_group = SIZE_MAX;
    if (Status s =
            decode_group(chunk, surface, resolve_threads(options.threads), keep, state, synthesis);
        !s.ok()) {
      state = {};
      return s;
    }
    if (keep) state_group = i;
  }
  open_group = group;
  return {};
}

Decoder::Decoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Decoder::~Decoder() = default;

Status Decoder::open(std::span<const uint8_t> bytes, const DecodeOptions& options,
                     std::unique_ptr<Decoder>& decoder) {
  auto impl = std::make_unique<Impl>();
  impl->options = options;
  if (Status s = impl->container.parse(bytes, options.limits); !s.ok()) return s;
  drop_broken_runs(impl->container.groups);
  impl->info = make_info(impl->container, bytes.size());
  decoder.reset(new Decoder(std::move(impl)));
  return {};
}

const StreamInfo& Decoder::info() const { return impl_->info; }

Status Decoder::connectivity(uint32_t frame, const Connectivity*& out) {
  size_t group = 0;
  if (Status s = impl_->find_group(frame, group); !s.ok()) return s;
  const uint32_t shot = impl_->container.groups[group].header.shot;
  if (!impl_->connectivities.contains(shot)) {
    if (Status s = impl_->open_shot(shot); !s.ok()) return s;
  }
  out = &impl_->connectivities.at(shot);
  return {};
}

Status Decoder::decode_frame(uint32_t frame, float* xyz, size_t stride) {
  size_t group = 0;
  if (Status s = impl_->find_group(frame, group); !s.ok()) return s;
  if (Status s = impl_->open(group); !s.ok()) return s;
  const GroupHeader& header = impl_->container.groups[group].header;
  impl_->synthesis.frame(frame - header.first_frame, impl_->surface.output, xyz, stride);
  return {};
}

namespace {

/// Appends the group's frames to `shot`, which has all earlier ones.
Status append_group(Decoder& decoder, const StreamInfo::Group& group, Shot& shot) {
  const size_t frame_size = size_t{shot.connectivity.vertex_count} * 3;
  for (uint32_t t = 0; t < group.frame_count; ++t) {
    // Frame by frame, so that what is zeroed is still in the cache when it is written.
    shot.positions.resize(frame_size * (shot.frame_count + 1));
    float* xyz = shot.positions.data() + frame_size * shot.frame_count++;
    if (Status s = decoder.decode_frame(group.first_frame + t, xyz, 3); !s.ok()) return s;
  }
  return {};
}

/// Frames of each shot.
std::map<uint32_t, uint64_t> count_frames(const StreamInfo& info) {
  std::map<uint32_t, uint64_t> out;
  for (const StreamInfo::Group& group : info.groups) out[group.shot] += group.frame_count;
  return out;
}

}  // namespace

Status decode_sequence(std::span<const uint8_t> bytes, const DecodeOptions& options,
                       Sequence& out) {
  std::unique_ptr<Decoder> decoder;
  if (Status s = Decoder::open(bytes, options, decoder); !s.ok()) return s;
  const StreamInfo& info = decoder->info();
  const std::map<uint32_t, uint64_t> frames = count_frames(info);
  uint64_t floats = 0;
  uint32_t newest = UINT32_MAX;
  Sequence sequence;
  sequence.frame_rate = info.frame_rate;
  sequence.start_time = info.start_time;
  for (const auto& [key, value] : info.metadata) sequence.metadata[key] = value;
  for (const StreamInfo::Group& group : info.groups) {
    if (group.shot != newest) {
      const Connectivity* connectivity = nullptr;
      if (Status s = decoder->connectivity(group.first_frame, connectivity); !s.ok()) return s;
      floats += 3 * connectivity->vertex_count * frames.at(group.shot);
      if (floats > options.limits.max_memory / sizeof(float))
        return Status::limit("the sequence needs more memory than the limit allows");
      sequence.shots.emplace_back().connectivity = *connectivity;
      sequence.shots.back().positions.reserve(3 * connectivity->vertex_count *
                                              frames.at(group.shot));
      newest = group.shot;
    }
    if (Status s = append_group(*decoder, group, sequence.shots.back()); !s.ok()) return s;
  }
  out = std::move(sequence);
  return {};
}

}  // namespace reeb
