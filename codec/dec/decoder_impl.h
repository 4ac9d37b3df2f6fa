// What a decoder is made of: the container, what it keeps, and how calls take turns.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <string>
#include <vector>

#include "bitstream/container_parser.h"
#include "codec/dec/attributes/attribute_store.h"
#include "codec/dec/decoder.h"
#include "codec/dec/group_store.h"
#include "codec/dec/guard.h"
#include "codec/dec/pushed_source.h"

namespace reeb {

/// As messages name it, counted from 1.
inline std::string frame_name(uint32_t frame) {
  return "frame " + std::to_string(uint64_t{frame} + 1);
}

/// Whether a target has places for the floats of `vertices`.
Status check_target(const FrameTarget& target, uint32_t vertices);

struct Decoder::Impl {
  Impl(std::unique_ptr<ByteSource> bytes, const DecodeOptions& o)
      : options(o),
        memory(o.resource()),
        source(std::move(bytes)),
        account(o.limits.max_memory),
        store(*source, options, account),
        attribute_store(*source, account, store) {}

  const DecodeOptions options;
  std::pmr::memory_resource* const memory;
  std::unique_ptr<ByteSource> source;
  PushedSource* pushed = nullptr;  ///< the source, where bytes are pushed
  MemoryAccount account;
  Lease own_lease, pushed_lease, info_lease;
  ContainerReader container;
  std::unique_ptr<ContainerParser> parser;  ///< of pushed bytes
  bool complete = true;                     ///< no bytes will come
  StreamInfo info;
  GroupStore store;
  AttributeStore attribute_store;

  std::mutex turn;     ///< held by each call
  StopToken stop_now;  ///< of the call that has its turn
  std::atomic<uint32_t> cancels{0};
  std::atomic<bool> loop{false};
  int64_t last_frame = -1;
  DecodeStats stats;
  uint64_t decoded_before = 0, ahead_before = 0;  ///< groups, at the last reset

  Status find_group(uint32_t frame, size_t& index) const;
  Status make_request(size_t group, GroupRequest& request) const;
  Status find_reference(size_t group, const ReferenceChunk*& reference) const;
  Status reference_of(uint32_t frame, const ReferenceChunk*& reference) const;
  Status faces_of(uint32_t frame, std::shared_ptr<ShotFaces>& faces);
  Status triangles_of(ShotFaces& faces);
  /// The group of a frame that has at most `most_vertices`.
  Status open_group(uint32_t frame, size_t most_vertices, const StopToken& stop,
                    std::shared_ptr<const OpenGroup>& group);
  Status positions(uint32_t frame, const StopToken& stop, const FrameTarget& target,
                   std::shared_ptr<ShotFaces>& faces);
  Status normals(ShotFaces& faces, const FrameTarget& target);
  Status between(uint32_t frame, double share, const StopToken& stop, const FrameTarget& target);
  Status blend(uint32_t frame, double share, const StopToken& stop, const FrameTarget& target,
               uint32_t vertices);
  Status check_time(double time) const;
  void look_ahead(uint32_t frame);
  Status parse_pushed(bool last);
  /// Counts what there is before anything is read, contexts mostly, and small things that are not
  /// counted later.
  Status take_own() {
    constexpr uint64_t kOwnBytes = uint64_t{7} << 14;
    return own_lease.grow(account, kOwnBytes)
               ? Status()
               : Status::limit("a decoder needs more memory than the limit allows");
  }
  /// Tells what the container has from a group on.
  Status tell(size_t first_group);

  // decoder_attributes.cpp
  Status find_attribute(uint32_t frame, uint32_t index, std::shared_ptr<const KeptAttribute>& kept);
  Status find_material(uint32_t frame, std::shared_ptr<const KeptAttribute>& kept);
  Status find_resource(uint32_t index, const ResourceChunk*& chunk) const;
  Status attribute_numbers(uint32_t frame, const std::shared_ptr<const KeptAttribute>& kept,
                           const StopToken& stop, SiteNumbers& out);
  /// What is coded of an animated attribute: values, or corrections of computed normals.
  Status coded_numbers(uint32_t frame, const std::shared_ptr<const KeptAttribute>& kept,
                       const StopToken& stop, SiteNumbers& out);
  Status decode_normals(uint32_t frame, const std::shared_ptr<const KeptAttribute>& kept,
                        const StopToken& stop, SiteNumbers& out);
  Status describe_attributes(uint32_t frame, std::vector<Attribute>& out,
                             std::vector<uint32_t>& indices);
  Status make_render_mesh(uint32_t frame, std::span<const uint32_t> split_by,
                          std::unique_ptr<const RenderMesh>& out);
  /// A mesh fits the frames of its own shot.
  Status check_shot(uint32_t frame, const RenderMesh& mesh) const;
  Status render_frame(uint32_t frame, double share, const RenderMesh& mesh, const StopToken& stop,
                      const FrameTarget& target);

  /// Runs a call: one at a time, without exceptions.
  template <class Call>
  Status run(Call&& call) {
    const StopToken stop(cancels);
    return guarded([&] {
      const std::lock_guard lock(turn);
      stop_now = stop;
      attribute_store.set_stop(stop);
      return call(stop);
    });
  }
};

}  // namespace reeb
