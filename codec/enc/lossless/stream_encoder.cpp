#include "codec/enc/lossless/stream_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <future>
#include <unordered_map>
#include <utility>

#include "bitstream/container.h"
#include "bitstream/crc32c.h"
#include "bitstream/element_bound.h"
#include "codec/common/base/float_state.h"
#include "codec/common/base/parallel.h"
#include "codec/enc/lossless/lossless_group_encoder.h"

namespace reeb {

namespace {

constexpr uint64_t kGroupBytes = 64 << 20;  ///< of positions that a group holds, unless asked for
constexpr uint32_t kMinFrames = 16;         ///< of a group, however large they are
constexpr uint32_t kGridBits = 10;  ///< of the reference mesh, which serves prediction alone

}  // namespace

struct StreamEncoder::Impl {
  StreamOptions options;
  ByteSink sink;
  std::vector<uint8_t> pending;  ///< bytes of the file that the sink has not got yet
  ContainerWriter writer{pending};
  uint64_t sent = 0;
  uint32_t shots = 0;
  uint32_t frames_done = 0;  ///< of all groups that are closed
  uint32_t frames_queued = 0;
  Shot first;  ///< connectivity and first frame of the shot
  std::shared_ptr<const SurfaceContext> surface;
  ExactFrames frames;                                  ///< of the open group
  std::unordered_multimap<uint32_t, uint32_t> newest;  ///< frame of each content, by checksum
  std::deque<std::future<LosslessGroup>> queue;

  Status flush();
  Status open_surface(std::span<const float> xyz);
  uint32_t take_copy(const std::vector<float>& frame, uint32_t checksum);
  bool group_full() const;
  Status close_group();
  Status write_oldest();
  Status drain(size_t most_left);
};

Status StreamEncoder::Impl::flush() {
  if (!pending.empty() && !sink(pending)) return Status::io("the output cannot be written");
  sent += pending.size();
  writer.flush();
  return {};
}

Status StreamEncoder::Impl::open_surface(std::span<const float> xyz) {
  first.positions.assign(xyz.begin(), xyz.end());
  first.frame_count = 1;
  auto made = std::make_shared<SurfaceContext>();
  ReferencePlan plan(first.connectivity);
  if (Status s = make_surface_context(
          first, plan, kGridBits, {.reorder = options.reorder, .face_order = options.face_order},
          *made);
      !s.ok())
    return s;
  made->header.shot = shots - 1;
  made->header.first_frame = frames_queued;
  if (Status s = writer.reference(made->header, made->bytes); !s.ok()) return s;
  surface = std::move(made);
  return flush();
}

/// Frames back to the newest equal one, or 0; the next frame becomes the newest.
uint32_t StreamEncoder::Impl::take_copy(const std::vector<float>& frame, uint32_t checksum) {
  const uint32_t now = frames.frame_count();
  const auto [begin, end] = newest.equal_range(checksum);
  for (auto at = begin; at != end; ++at) {
    const std::vector<float>& other = frames[at->second];
    if (std::memcmp(other.data(), frame.data(), sizeof(float) * frame.size()) == 0)
      return now - std::exchange(at->second, now);
  }
  newest.emplace(checksum, now);
  return 0;
}

bool StreamEncoder::Impl::group_full() const {
  const uint32_t count = frames.frame_count();
  if (options.group_length > 0) return count == options.group_length;
  const uint64_t held = frames.stored_count() * uint64_t{surface->rows()} * 3 * sizeof(float);
  return count == kMaxGroupFrames || (count >= kMinFrames && held >= kGroupBytes);
}

Status StreamEncoder::Impl::close_group() {
  if (frames.frame_count() == 0) return {};
  frames_queued += frames.frame_count();
  queue.push_back(
      std::async(resolve_threads(options.threads) > 1 ? std::launch::async : std::launch::deferred,
                 [graph = surface, group = std::move(frames), method = options.method] {
                   const FloatState state;
                   return encode_lossless_group(*graph, group, method, 1);
                 }));
  frames = {};
  newest.clear();
  return drain(resolve_threads(options.threads) - 1);
}

Status StreamEncoder::Impl::write_oldest() {
  const LosslessGroup group = queue.front().get();
  queue.pop_front();
  if (options.method.stop.requested()) return Status::cancelled();
  GroupHeader header;
  header.first_frame = frames_done;
  header.frame_count = group.frame_count;
  header.shot = shots - 1;
  header.profile = Profile::kLossless;
  header.flags = options.method.quick ? GroupHeader::kQuick : uint8_t{0};
  header.stored_count = group.stored_count;
  frames_done += group.frame_count;
  std::vector<uint8_t> padded;
  const GroupSections sections = within_element_bound(
      header, group.vertex_count, {.differences = group.differences, .raw = group.raw}, padded);
  if (Status s = writer.group(header, sections); !s.ok()) return s;
  return flush();
}

/// Writes groups until at most `most_left` are being encoded.
Status StreamEncoder::Impl::drain(size_t most_left) {
  while (queue.size() > most_left) {
    if (Status s = write_oldest(); !s.ok()) return s;
  }
  return {};
}

StreamEncoder::StreamEncoder(const StreamOptions& options, ByteSink sink)
    : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->sink = std::move(sink);
}

StreamEncoder::~StreamEncoder() = default;

uint64_t StreamEncoder::bytes() const { return impl_->sent; }

Status StreamEncoder::begin(const SequenceHeader& header,
                            const std::vector<MetadataEntry>& metadata) {
  const FloatState state;
  if (Status s = impl_->writer.begin(header); !s.ok()) return s;
  if (Status s = impl_->writer.metadata(metadata); !s.ok()) return s;
  return impl_->flush();
}

Status StreamEncoder::begin_shot(const Connectivity& connectivity) {
  const FloatState state;
  if (Status s = impl_->close_group(); !s.ok()) return s;
  if (Status s = impl_->drain(0); !s.ok()) return s;
  impl_->surface = nullptr;
  impl_->first.connectivity = connectivity;
  ++impl_->shots;
  return {};
}

Status StreamEncoder::add_frame(std::span<const float> xyz) {
  const FloatState state;
  Impl& s = *impl_;
  if (s.shots == 0 || xyz.size() != size_t{s.first.connectivity.vertex_count} * 3)
    return Status::invalid("a frame's vertices are not those of the shot");
  if (!std::all_of(xyz.begin(), xyz.end(), [](float x) { return std::isfinite(x); }))
    return Status::invalid("a position is not finite");
  if (s.surface == nullptr) {
    if (Status status = s.open_surface(xyz); !status.ok()) return status;
  }
  std::vector<float> frame;
  frame.reserve(xyz.size());
  for (const uint32_t v : s.surface->input)
    frame.insert(frame.end(), &xyz[v * size_t{3}], &xyz[v * size_t{3}] + 3);
  const uint32_t checksum =
      crc32c({reinterpret_cast<const uint8_t*>(frame.data()), sizeof(float) * frame.size()});
  if (const uint32_t distance = s.take_copy(frame, checksum); distance > 0) {
    s.frames.repeat(distance);
  } else {
    s.frames.add(std::move(frame));
  }
  return s.group_full() ? s.close_group() : Status();
}

Status StreamEncoder::finish() {
  const FloatState state;
  if (Status s = impl_->close_group(); !s.ok()) return s;
  if (Status s = impl_->drain(0); !s.ok()) return s;
  if (Status s = impl_->writer.finish(); !s.ok()) return s;
  return impl_->flush();
}

}  // namespace reeb
