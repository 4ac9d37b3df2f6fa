// Decodes groups, keeps the last ones, and decodes one ahead on a thread of its own; all within the
// memory that the caller allows.
#pragma once

#include <condition_variable>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "bitstream/container.h"
#include "bitstream/memory_account.h"
#include "codec/common/base/sequence.h"
#include "codec/common/base/stop.h"
#include "codec/dec/decode_options.h"
#include "codec/dec/group_decoder.h"

namespace reeb {

/// Faces of a shot, kept as long as the store.
struct ShotFaces {
  explicit ShotFaces(std::pmr::memory_resource* memory) : triangles(memory) {}
  Connectivity connectivity;
  std::pmr::vector<uint32_t> triangles;  ///< empty until asked for
  Lease lease;
};

/// A shot's reference mesh, ready for its groups.
struct OpenShot {
  uint32_t shot = 0;
  DecodedSurface surface;
  std::shared_ptr<ShotFaces> faces;
  Lease lease;
};

/// A decoded group, ready to give its frames.
struct OpenGroup {
  GroupHeader header;
  std::shared_ptr<const OpenShot> shot;
  GroupSynthesis synthesis;
  Lease lease;
};

/// What it takes to decode a group: those that it continues, too. Offsets in the file are their
/// names here.
struct GroupRequest {
  std::vector<GroupChunk> run;  ///< from one that continues none to the group itself
  ReferenceChunk reference;
  bool continued = false;  ///< the next group continues this one

  uint64_t offset() const { return run.back().offset; }
};

/// What a group has learned, for the next one.
struct HeldState {
  uint64_t offset = UINT64_MAX;  ///< of the group
  std::shared_ptr<const OpenShot> shot;
  GroupState state;
  Lease lease;
};

/// Any thread may call; `get` one at a time.
class GroupStore {
 public:
  /// `source` and `account` must outlive the store. Calls of `source` come one at a time.
  GroupStore(ByteSource& source, const DecodeOptions& options, MemoryAccount& account);
  ~GroupStore();
  GroupStore(const GroupStore&) = delete;
  GroupStore& operator=(const GroupStore&) = delete;

  /// The group, kept or decoded now.
  Status get(const GroupRequest& request, const StopToken& stop,
             std::shared_ptr<const OpenGroup>& out);

  // All of these throw Stopped where `stop` is requested.

  /// The faces of a shot, decoding its reference mesh where that was not done yet.
  Status get_faces(const ReferenceChunk& reference, const StopToken& stop,
                   std::shared_ptr<ShotFaces>& out);

  /// The shot, decoding its reference mesh where it is not kept.
  Status get_shot(const ReferenceChunk& reference, const StopToken& stop,
                  std::shared_ptr<const OpenShot>& out) {
    return open_shot(reference, Caller::kPlayer, stop, out);
  }

  /// Decodes the next group of a run past the cache, for as many threads at a time as memory
  /// allows. `keep`: another one of the run follows, with the same `state`.
  Status decode_next(const GroupChunk& chunk, const ReferenceChunk& reference, unsigned threads,
                     bool keep, HeldState& state, std::shared_ptr<const OpenGroup>& out);

  /// Starts to decode the group on the store's own thread, if it is not kept already.
  void prefetch(const GroupRequest& request);

  /// Lets calls that wait look at their stop token again, and gives up what is decoded ahead.
  void interrupt();

  /// Locks the source, so that it may be changed.
  std::unique_lock<std::mutex> lock_source() { return std::unique_lock(source_mutex_); }

  /// Groups decoded so far: in all, and ahead.
  uint64_t decoded_count() const { return decoded_count_; }
  uint64_t ahead_count() const { return ahead_count_; }

 private:
  enum class Caller { kPlayer, kWorker };
  static constexpr uint64_t kNone = UINT64_MAX;
  /// How a group is to be decoded, and for whom.
  struct Job {
    const ReferenceChunk& reference;
    unsigned threads;
    Caller caller;
    const StopToken& stop;
  };

  std::shared_ptr<const OpenGroup> find(uint64_t offset);
  void keep(std::shared_ptr<const OpenGroup> group, uint64_t offset);
  bool drop_oldest(Caller caller);
  Status acquire(uint64_t bytes, Caller caller, Lease& lease);
  std::shared_ptr<const OpenShot> find_shot(uint32_t shot);
  Status open_shot(const ReferenceChunk& reference, Caller caller, const StopToken& stop,
                   std::shared_ptr<const OpenShot>& out);
  Status decode(const GroupRequest& request, Caller caller, const StopToken& stop,
                std::shared_ptr<const OpenGroup>& out);
  Status decode_one(const GroupChunk& chunk, const Job& job, bool keep, HeldState& state,
                    std::shared_ptr<const OpenGroup>& out);
  size_t take_state(const GroupRequest& request, HeldState& state);
  void work();

  struct Entry {
    uint64_t offset = 0;
    std::shared_ptr<const OpenGroup> group;
  };

  ByteSource& source_;
  std::mutex source_mutex_;
  const DecodeOptions options_;
  MemoryAccount& account_;

  std::mutex mutex_;                     // of all below
  std::condition_variable changed_;      // any of it
  std::list<Entry> entries_;             // most recently used first
  uint64_t in_use_ = kNone;              // group last got
  std::map<uint64_t, Status> failures_;  // groups that will never decode
  std::map<uint32_t, std::shared_ptr<ShotFaces>> faces_;
  std::shared_ptr<const OpenShot> latest_shot_;
  HeldState held_;                      // of the group decoded last that another one continues
  std::optional<GroupRequest> wanted_;  // by the worker
  uint64_t working_on_ = kNone;
  uint64_t given_up_ = kNone;  // what the worker had no memory for
  bool closing_ = false;
  std::atomic<uint32_t> worker_stops_{0};
  std::atomic<uint64_t> decoded_count_{0}, ahead_count_{0};
  std::thread worker_;
};

}  // namespace reeb
