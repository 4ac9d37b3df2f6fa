#include "codec/dec/group_store.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "codec/common/base/parallel.h"
#include "codec/dec/group_memory.h"
#include "codec/dec/guard.h"
#include "codec/dec/reference_mesh_decoder.h"

namespace reeb {

namespace {

DecodedSurface make_surface(ReferenceMesh mesh, const ReferenceHeader& header,
                            const StopToken& stop) {
  DecodedSurface out;
  out.surface = Surface(mesh, stop);
  out.output.reserve(out.surface.order.size());
  for (const uint32_t v : out.surface.order) out.output.push_back(mesh.output_index[v]);
  std::copy(std::begin(header.origin), std::end(header.origin), out.origin);
  out.grid_step = header.grid_step;
  return out;
}

}  // namespace

GroupStore::GroupStore(ByteSource& source, const DecodeOptions& options, MemoryAccount& account)
    : source_(source), options_(options), account_(account) {}

GroupStore::~GroupStore() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    ++worker_stops_;
  }
  changed_.notify_all();
  if (worker_.joinable()) worker_.join();
}

// The group, now the most recently used one; call with the mutex locked.
std::shared_ptr<const OpenGroup> GroupStore::find(uint64_t offset) {
  for (auto it = entries_.begin(); it != entries_.end(); ++it) {
    if (it->offset != offset) continue;
    entries_.splice(entries_.begin(), entries_, it);
    return it->group;
  }
  return nullptr;
}

void GroupStore::keep(std::shared_ptr<const OpenGroup> group, uint64_t offset) {
  entries_.push_front({offset, std::move(group)});
  uint64_t bytes = 0;
  size_t rank = 0;
  for (auto it = entries_.begin(); it != entries_.end(); ++rank) {
    bytes += it->group->lease.bytes();
    const bool surplus = rank > 0 && it->offset != in_use_ && bytes > options_.cache_bytes;
    it = surplus ? entries_.erase(it) : std::next(it);
  }
}

// False where there is nothing that this caller may drop.
bool GroupStore::drop_oldest(Caller caller) {
  for (auto it = entries_.end(); it != entries_.begin();) {
    --it;
    if (caller == Caller::kWorker && it->offset == in_use_) continue;
    entries_.erase(it);
    return true;
  }
  if (held_.offset != kNone) {
    held_ = {};
    return true;
  }
  if (caller == Caller::kWorker || !latest_shot_ || latest_shot_.use_count() > 1) return false;
  latest_shot_.reset();
  return true;
}

// Makes room for `bytes`: first by dropping old groups, then by giving up what is decoded ahead.
Status GroupStore::acquire(uint64_t bytes, Caller caller, Lease& lease) {
  std::unique_lock lock(mutex_);
  while (!lease.grow(account_, bytes)) {
    if (drop_oldest(caller)) continue;
    if (caller == Caller::kWorker || working_on_ == kNone)
      return Status::limit("the stream needs more memory than the limit allows");
    wanted_.reset();
    ++worker_stops_;
    changed_.wait(lock, [&] { return working_on_ == kNone; });
  }
  return {};
}

std::shared_ptr<const OpenShot> GroupStore::find_shot(uint32_t shot) {
  const std::lock_guard lock(mutex_);
  if (latest_shot_ && latest_shot_->shot == shot) return latest_shot_;
  for (const Entry& entry : entries_) {
    if (entry.group->shot->shot == shot) return entry.group->shot;
  }
  return nullptr;
}

Status GroupStore::open_shot(const ReferenceChunk& reference, Caller caller, const StopToken& stop,
                             std::shared_ptr<const OpenShot>& out) {
  out = find_shot(reference.header.shot);
  if (out) return {};
  auto shot = std::make_shared<OpenShot>();
  shot->shot = reference.header.shot;
  if (Status s =
          acquire(reference.size + reference_memory(reference.mesh_header, 0), caller, shot->lease);
      !s.ok())
    return s;
  ReferenceChunk chunk = reference;
  std::vector<uint8_t> buffer;
  {
    const auto lock = lock_source();
    if (Status s = load_chunk(source_, buffer, chunk); !s.ok()) return s;
  }
  const uint64_t triangles = announced_triangles(chunk.mesh);
  if (Status s = acquire(reference_memory({.vertex_count = 0}, triangles), caller, shot->lease);
      !s.ok())
    return s;
  ReferenceMesh mesh;
  if (Status s = decode_reference(chunk.mesh, options_.limits, mesh, stop); !s.ok()) return s;
  auto faces = std::make_shared<ShotFaces>(options_.resource());
  faces->connectivity = std::move(mesh.connectivity);
  shot->surface = make_surface(std::move(mesh), chunk.header, stop);
  shot->lease.shrink(kept_memory(shot->surface));
  if (Status s = acquire(kept_memory(faces->connectivity), caller, faces->lease); !s.ok()) return s;
  const std::lock_guard lock(mutex_);
  shot->faces = faces_.try_emplace(shot->shot, std::move(faces)).first->second;
  latest_shot_ = shot;
  out = std::move(shot);
  return {};
}

// Decodes one group from `state`, and leaves there what the next one needs, if `keep`.
Status GroupStore::decode_one(const GroupChunk& wanted, const Job& job, bool keep, HeldState& state,
                              std::shared_ptr<const OpenGroup>& out) {
  if (job.stop.requested()) return Status::cancelled();
  auto group = std::make_shared<OpenGroup>();
  group->shot = state.shot;
  if (!group->shot) {
    if (Status s = open_shot(job.reference, job.caller, job.stop, group->shot); !s.ok()) return s;
  }
  const DecodedSurface& surface = group->shot->surface;
  const uint64_t vertices = surface.output.size();
  if (Status s = check_elements(wanted.header, vertices); !s.ok()) return s;
  const uint64_t kept = kept_memory(vertices, wanted.header);
  const uint64_t learned = keep && state.lease.bytes() == 0 ? state_memory(vertices) : 0;
  const uint64_t all = group_memory(vertices, wanted.header, keep) + wanted.size;
  const uint64_t there = state.lease.bytes();
  const uint64_t needed = std::max(all - std::min(all, there), kept + learned);
  if (Status s = acquire(needed, job.caller, group->lease); !s.ok()) return s;
  GroupChunk chunk = wanted;
  std::vector<uint8_t> buffer;
  {
    const auto lock = lock_source();
    if (Status s = load_chunk(source_, buffer, chunk); !s.ok()) return s;
  }
  if (Status s =
          decode_group(chunk, surface, job.threads, keep, state.state, group->synthesis, job.stop);
      !s.ok())
    return s;
  group->header = chunk.header;
  if (learned > 0) state.lease = group->lease.split(learned);
  group->lease.shrink(kept);
  state.offset = chunk.offset;
  state.shot = group->shot;
  ++decoded_count_;
  out = std::move(group);
  return {};
}

Status GroupStore::decode_next(const GroupChunk& chunk, const ReferenceChunk& reference,
                               unsigned threads, bool keep, HeldState& state,
                               std::shared_ptr<const OpenGroup>& out) {
  return decode_one(chunk, {reference, threads, Caller::kPlayer, {}}, keep, state, out);
}

// The first group of the run that must be decoded, and what the one before it has learned, if that
// is held.
size_t GroupStore::take_state(const GroupRequest& request, HeldState& state) {
  const std::lock_guard lock(mutex_);
  for (size_t i = request.run.size() - 1; i > 0; --i) {
    if (request.run[i - 1].offset != held_.offset) continue;
    state = std::exchange(held_, HeldState());
    return i;
  }
  return 0;
}

Status GroupStore::decode(const GroupRequest& request, Caller caller, const StopToken& stop,
                          std::shared_ptr<const OpenGroup>& out) {
  const Job job = {request.reference, resolve_threads(options_.threads), caller, stop};
  HeldState state;
  for (size_t i = take_state(request, state); i < request.run.size(); ++i) {
    const bool last = i + 1 == request.run.size();
    if (Status s = decode_one(request.run[i], job, !last || request.continued, state, out); !s.ok())
      return s;
    if (last) break;
    const std::lock_guard lock(mutex_);
    if (find(request.run[i].offset) == nullptr) keep(out, request.run[i].offset);
  }
  if (request.continued) {
    const std::lock_guard lock(mutex_);
    held_ = std::move(state);
  }
  return {};
}

Status GroupStore::get(const GroupRequest& request, const StopToken& stop,
                       std::shared_ptr<const OpenGroup>& out) {
  const uint64_t offset = request.offset();
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return working_on_ != offset || stop.requested(); });
    if (stop.requested()) return Status::cancelled();
    in_use_ = offset;
    if (wanted_ && wanted_->offset() == offset) wanted_.reset();
    if ((out = find(offset)) != nullptr) return {};
    if (const auto at = failures_.find(offset); at != failures_.end()) return at->second;
  }
  Status status = decode(request, Caller::kPlayer, stop, out);
  const std::lock_guard lock(mutex_);
  if (status.ok()) keep(out, offset);
  if (status.code() == StatusCode::kCorrupt) failures_.try_emplace(offset, status);
  return status;
}

Status GroupStore::get_faces(const ReferenceChunk& reference, const StopToken& stop,
                             std::shared_ptr<ShotFaces>& out) {
  {
    const std::lock_guard lock(mutex_);
    const auto at = faces_.find(reference.header.shot);
    if (at != faces_.end()) {
      out = at->second;
      return {};
    }
  }
  std::shared_ptr<const OpenShot> shot;
  if (Status s = open_shot(reference, Caller::kPlayer, stop, shot); !s.ok()) return s;
  out = shot->faces;
  return {};
}

void GroupStore::prefetch(const GroupRequest& request) {
  {
    const std::lock_guard lock(mutex_);
    const uint64_t offset = request.offset();
    if (offset == working_on_ || offset == given_up_ || failures_.contains(offset)) return;
    for (const Entry& entry : entries_) {
      if (entry.offset == offset) return;
    }
    wanted_ = request;
    if (!worker_.joinable()) {
      try {
        worker_ = std::thread([this] { work(); });
      } catch (const std::system_error&) {  // no thread to be had: `get` does it all
        wanted_.reset();
      }
    }
  }
  changed_.notify_all();
}

void GroupStore::interrupt() {
  {
    const std::lock_guard lock(mutex_);
    wanted_.reset();
    ++worker_stops_;
  }
  changed_.notify_all();
}

void GroupStore::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return closing_ || wanted_.has_value(); });
    if (closing_) return;
    const GroupRequest request = *std::exchange(wanted_, std::nullopt);
    const uint64_t offset = working_on_ = request.offset();
    const StopToken stop(worker_stops_);
    lock.unlock();
    std::shared_ptr<const OpenGroup> group;
    Status status = guarded([&] { return decode(request, Caller::kWorker, stop, group); });
    lock.lock();
    if (status.ok()) {
      status = guarded([&] {
        keep(std::move(group), offset);
        return Status();
      });
      ++ahead_count_;
    }
    // `get` meets the failure itself, and says so.
    given_up_ = status.ok() ? kNone : offset;
    working_on_ = kNone;
    group.reset();
    changed_.notify_all();
  }
}

}  // namespace reeb
