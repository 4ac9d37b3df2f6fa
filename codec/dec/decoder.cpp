#include "codec/dec/decoder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "codec/common/mesh/faces.h"
#include "codec/dec/decoder_impl.h"
#include "codec/dec/normals.h"

namespace reeb {

namespace {

/// Frames that playing may skip from one call to the next.
constexpr int64_t kLeap = 8;
/// How much is computed between two looks whether it is still wanted.
constexpr uint32_t kFramesAtOnce = 16, kPositionsAtOnce = 1u << 21;

}  // namespace

Status check_target(const FrameTarget& target, uint32_t vertices) {
  const bool wrong = target.positions == nullptr || target.stride < 3 ||
                     (target.normals != nullptr && target.normal_stride < 3);
  if (wrong) return Status::invalid("the target has no positions, or a stride below 3");
  if (vertices > target.vertex_capacity)
    return Status::invalid("there are more vertices than there is room for");
  return {};
}

Status Decoder::Impl::find_group(uint32_t frame, size_t& index) const {
  const auto& groups = container.groups;
  const auto after =
      std::upper_bound(groups.begin(), groups.end(), frame,
                       [](uint32_t f, const GroupChunk& g) { return f < g.header.first_frame; });
  if (after != groups.begin()) {
    const GroupHeader& h = std::prev(after)->header;
    index = static_cast<size_t>(std::prev(after) - groups.begin());
    if (frame - h.first_frame < h.frame_count) return {};
  }
  const bool has_header = info.format_version != 0;
  if (has_header && frame >= container.header.total_frames)
    return Status::invalid(frame_name(frame) + " is past the end");
  if (!complete && after == groups.end())
    return {StatusCode::kNeedMoreData, frame_name(frame) + " is still to come"};
  return Status::corrupt(frame_name(frame) + " is missing: its group is damaged or cut off");
}

// The group and those before it that it continues.
Status Decoder::Impl::make_request(size_t group, GroupRequest& request) const {
  const auto& groups = container.groups;
  size_t first = group;
  for (; groups[first].continues(); --first) {
    if (group - first == kMaxOpenGroups)
      return Status::corrupt("too many groups in a row continue each other");
    if (first == 0 || !follows(groups[first], groups[first - 1])) {
      return Status::corrupt(frame_name(groups[group].header.first_frame) +
                             " is missing: a group that its own continues is damaged or cut off");
    }
  }
  request.run.assign(groups.begin() + static_cast<ptrdiff_t>(first),
                     groups.begin() + static_cast<ptrdiff_t>(group) + 1);
  request.continued = group + 1 < groups.size() && groups[group + 1].continues();
  const ReferenceChunk* reference = nullptr;
  if (Status s = find_reference(group, reference); !s.ok()) return s;
  request.reference = *reference;
  return {};
}

Status Decoder::Impl::find_reference(size_t group, const ReferenceChunk*& reference) const {
  const uint32_t shot = container.groups[group].header.shot;
  reference = container.reference(shot);
  if (reference != nullptr) return {};
  return Status::corrupt("reference mesh " + std::to_string(shot + 1) + " is missing or damaged");
}

Status Decoder::Impl::reference_of(uint32_t frame, const ReferenceChunk*& reference) const {
  size_t group = 0;
  if (Status s = find_group(frame, group); !s.ok()) return s;
  return find_reference(group, reference);
}

Status Decoder::Impl::faces_of(uint32_t frame, std::shared_ptr<ShotFaces>& faces) {
  const ReferenceChunk* reference = nullptr;
  if (Status s = reference_of(frame, reference); !s.ok()) return s;
  return store.get_faces(*reference, stop_now, faces);
}

Status Decoder::Impl::triangles_of(ShotFaces& faces) {
  if (!faces.triangles.empty()) return {};
  const Connectivity& c = faces.connectivity;
  const size_t count = fan_triangles(c.face_sizes, c.corners, nullptr);
  if (!faces.lease.grow(account, count * sizeof(uint32_t)))
    return Status::limit("the triangles need more memory than the limit allows");
  std::pmr::vector<uint32_t> triangles(count, memory);
  fan_triangles(c.face_sizes, c.corners, triangles.data());
  faces.triangles = std::move(triangles);
  return {};
}

Status Decoder::Impl::open_group(uint32_t frame, size_t most_vertices, const StopToken& stop,
                                 std::shared_ptr<const OpenGroup>& group) {
  size_t index = 0;
  if (Status s = find_group(frame, index); !s.ok()) return s;
  GroupRequest request;
  if (Status s = make_request(index, request); !s.ok()) return s;
  if (request.reference.mesh_header.vertex_count > most_vertices)
    return Status::invalid(frame_name(frame) + " has more vertices than there is room for");
  return store.get(request, stop, group);
}

Status Decoder::Impl::positions(uint32_t frame, const StopToken& stop, const FrameTarget& target,
                                std::shared_ptr<ShotFaces>& faces) {
  std::shared_ptr<const OpenGroup> group;
  if (Status s = open_group(frame, target.vertex_capacity, stop, group); !s.ok()) return s;
  group->synthesis.frame(frame - group->header.first_frame, target.positions, target.stride);
  faces = group->shot->faces;
  return {};
}

Status Decoder::Impl::normals(ShotFaces& faces, const FrameTarget& target) {
  if (target.normals == nullptr) return {};
  if (Status s = triangles_of(faces); !s.ok()) return s;
  Lease lease;
  const size_t values = size_t{faces.connectivity.vertex_count} * 3;
  if (!lease.grow(account, values * sizeof(double)))
    return Status::limit("the normals need more memory than the limit allows");
  std::pmr::vector<double> sums(values, memory);
  vertex_normals(faces.triangles, target.positions, target.stride, sums, target.normals,
                 target.normal_stride);
  return {};
}

// Moves the frame in `target` towards the one after it.
Status Decoder::Impl::blend(uint32_t frame, double share, const StopToken& stop,
                            const FrameTarget& target, uint32_t vertices) {
  Lease lease;
  if (!lease.grow(account, uint64_t{vertices} * 3 * sizeof(float)))
    return Status::limit("the frame needs more memory than the limit allows");
  std::pmr::vector<float> next(size_t{vertices} * 3, memory);
  std::shared_ptr<ShotFaces> faces;
  if (Status s = positions(frame + 1, stop, {.positions = next.data()}, faces); !s.ok()) return s;
  for (size_t v = 0; v < vertices; ++v) {
    for (size_t a = 0; a < 3; ++a) {
      float& x = target.positions[v * target.stride + a];
      x = static_cast<float>((1 - share) * double{x} + share * double{next[v * 3 + a]});
    }
  }
  return {};
}

Status Decoder::Impl::between(uint32_t frame, double share, const StopToken& stop,
                              const FrameTarget& target) {
  if (Status s = check_target(target, 0); !s.ok()) return s;
  const auto start = std::chrono::steady_clock::now();
  std::shared_ptr<ShotFaces> faces;
  if (Status s = positions(frame, stop, target, faces); !s.ok()) return s;
  if (share > 0) {
    size_t here = 0, next = 0;
    const bool found = find_group(frame, here).ok() && find_group(frame + 1, next).ok();
    if (found && container.groups[here].header.shot == container.groups[next].header.shot) {
      const uint32_t vertices = faces->connectivity.vertex_count;
      if (Status s = blend(frame, share, stop, target, vertices); !s.ok()) return s;
    }
  }
  if (Status s = normals(*faces, target); !s.ok()) return s;
  look_ahead(frame);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ++stats.frames;
  if (took.count() > stats.longest_stall) {
    stats.longest_stall = took.count();
    stats.longest_stall_frame = frame;
  }
  return {};
}

Status Decoder::Impl::check_time(double time) const {
  const double last = static_cast<double>(info.frame_count) - 1;
  if (time >= 0 && time <= last) return {};
  return Status::invalid("the time is outside the sequence");
}

// Starts on the group that playing will meet next, if frames are asked for one after another.
void Decoder::Impl::look_ahead(uint32_t frame) {
  const int64_t last = std::exchange(last_frame, int64_t{frame});
  if (!options.prefetch || last < 0) return;
  const bool looping = loop;
  int64_t way = int64_t{frame} - last;
  const int64_t around = info.frame_count;
  if (looping && way < kLeap - around) way += around;
  if (looping && way > around - kLeap) way -= around;
  if (way == 0 || way > kLeap || way < -kLeap) return;
  size_t index = 0;
  if (!find_group(frame, index).ok()) return;
  const size_t count = container.groups.size();
  if (!looping && (way > 0 ? index + 1 == count : index == 0)) return;
  GroupRequest request;
  if (!make_request((way > 0 ? index + 1 : index + count - 1) % count, request).ok()) return;
  // Without memory for it the next group is decoded when its turn comes.
  (void)guarded([&] {
    store.prefetch(request);
    return Status();
  });
}

Status Decoder::Impl::parse_pushed(bool last) {
  const auto lock = store.lock_source();
  const size_t groups = last ? 0 : container.groups.size();
  Status status = parser->advance(last);
  // A damaged file has been read once more, which may have found more of it.
  if (last) info = {};
  complete = last;
  if (!parser->has_header()) return status;
  Status told = tell(groups);
  return status.ok() ? told : status;
}

Status Decoder::Impl::tell(size_t first_group) {
  const uint64_t needed = info_memory(container);
  const uint64_t there = info_lease.bytes();
  if (needed > there && !info_lease.grow(account, needed - there))
    return Status::limit("the headers need more memory than allowed");
  update_info(container, source->size(), complete, first_group, info);
  return {};
}

Decoder::Decoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Decoder::~Decoder() = default;

Status Decoder::open(std::span<const uint8_t> bytes, const DecodeOptions& options,
                     std::unique_ptr<Decoder>& decoder) {
  return guarded([&]() -> Status {
    auto impl = std::make_unique<Impl>(std::make_unique<MemorySource>(bytes), options);
    if (Status s = impl->take_own(); !s.ok()) return s;
    if (Status s = impl->container.parse(bytes, options.limits, impl->account); !s.ok()) return s;
    if (Status s = impl->tell(0); !s.ok()) return s;
    decoder.reset(new Decoder(std::move(impl)));
    return {};
  });
}

Status Decoder::open(std::unique_ptr<ByteSource> source, const DecodeOptions& options,
                     std::unique_ptr<Decoder>& decoder) {
  return guarded([&]() -> Status {
    auto impl = std::make_unique<Impl>(std::move(source), options);
    if (Status s = impl->take_own(); !s.ok()) return s;
    if (Status s = impl->container.open(*impl->source, options.limits, impl->account); !s.ok())
      return s;
    if (Status s = impl->tell(0); !s.ok()) return s;
    decoder.reset(new Decoder(std::move(impl)));
    return {};
  });
}

Status Decoder::open_pushed(const DecodeOptions& options, std::unique_ptr<Decoder>& decoder) {
  return guarded([&]() -> Status {
    auto source = std::make_unique<PushedSource>(options.resource());
    PushedSource* pushed = source.get();
    auto impl = std::make_unique<Impl>(std::move(source), options);
    if (Status s = impl->take_own(); !s.ok()) return s;
    impl->pushed = pushed;
    impl->complete = false;
    impl->parser = std::make_unique<ContainerParser>(*pushed, impl->options.limits, Checksums::kNow,
                                                     impl->account, impl->container);
    decoder.reset(new Decoder(std::move(impl)));
    return {};
  });
}

Status Decoder::push(std::span<const uint8_t> bytes) {
  return impl_->run([&](const StopToken&) -> Status {
    Impl& d = *impl_;
    if (d.pushed == nullptr || d.complete)
      return Status::invalid("the stream takes no bytes, or no more of them");
    if (!d.pushed_lease.grow(d.account, d.pushed->memory_for(bytes.size())))
      return Status::limit("the file is larger than the memory limit");
    {
      const auto lock = d.store.lock_source();
      d.pushed->append(bytes);
    }
    return d.parse_pushed(false);
  });
}

Status Decoder::finish() {
  return impl_->run([&](const StopToken&) -> Status {
    if (impl_->pushed == nullptr || impl_->complete)
      return Status::invalid("the stream takes no bytes, or no more of them");
    return impl_->parse_pushed(true);
  });
}

const StreamInfo& Decoder::info() const { return impl_->info; }

Status Decoder::connectivity(uint32_t frame, const Connectivity*& out) {
  return impl_->run([&](const StopToken&) -> Status {
    std::shared_ptr<ShotFaces> faces;
    if (Status s = impl_->faces_of(frame, faces); !s.ok()) return s;
    out = &faces->connectivity;
    return {};
  });
}

Status Decoder::triangles(uint32_t frame, std::span<const uint32_t>& out) {
  return impl_->run([&](const StopToken&) -> Status {
    std::shared_ptr<ShotFaces> faces;
    if (Status s = impl_->faces_of(frame, faces); !s.ok()) return s;
    if (Status s = impl_->triangles_of(*faces); !s.ok()) return s;
    out = faces->triangles;
    return {};
  });
}

Status Decoder::decode_frame(uint32_t frame, const FrameTarget& target) {
  return impl_->run([&](const StopToken& stop) { return impl_->between(frame, 0, stop, target); });
}

Status Decoder::decode_frames(uint32_t first, uint32_t count, float* xyz, size_t frame_stride) {
  return impl_->run([&](const StopToken& stop) -> Status {
    if (xyz == nullptr) return Status::invalid("there is no place for positions");
    for (uint32_t done = 0; done < count;) {
      std::shared_ptr<const OpenGroup> group;
      if (Status s = impl_->open_group(first + done, frame_stride / 3, stop, group); !s.ok())
        return s;
      stop.check();
      const uint32_t at = first + done - group->header.first_frame;
      const uint32_t vertices = std::max(1u, group->shot->faces->connectivity.vertex_count);
      const uint32_t there = std::min({count - done, group->header.frame_count - at,
                                       std::max(kFramesAtOnce, kPositionsAtOnce / vertices)});
      group->synthesis.frames(at, there, xyz + done * frame_stride, frame_stride, 3);
      done += there;
      impl_->stats.frames += there;
      impl_->look_ahead(first + done - 1);
    }
    return {};
  });
}

Status Decoder::decode_at(double time, const FrameTarget& target) {
  return impl_->run([&](const StopToken& stop) -> Status {
    if (Status s = impl_->check_time(time); !s.ok()) return s;
    const double whole = std::floor(time);
    return impl_->between(static_cast<uint32_t>(whole), time - whole, stop, target);
  });
}

void Decoder::set_loop(bool loop) { impl_->loop = loop; }

void Decoder::cancel() {
  ++impl_->cancels;
  impl_->store.interrupt();
}

DecodeStats Decoder::stats() const {
  const std::lock_guard lock(impl_->turn);
  DecodeStats out = impl_->stats;
  out.groups_decoded = impl_->store.decoded_count() - impl_->decoded_before;
  out.groups_ahead = impl_->store.ahead_count() - impl_->ahead_before;
  out.memory = impl_->account.used();
  out.peak_memory = impl_->account.peak();
  return out;
}

void Decoder::reset_stats() {
  const std::lock_guard lock(impl_->turn);
  impl_->stats = {};
  impl_->decoded_before = impl_->store.decoded_count();
  impl_->ahead_before = impl_->store.ahead_count();
}

}  // namespace reeb
