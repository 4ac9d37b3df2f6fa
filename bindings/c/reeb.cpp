#include "reeb.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <string>

#include "bindings/c/handle.h"
#include "bitstream/chunk.h"
#include "bitstream/headers.h"
#include "codec/common/base/float_state.h"

namespace {

using reeb::Status;
using reeb::StatusCode;
using reeb_c::adopt;
using reeb_c::give;
using reeb_c::make_target;
using reeb_c::with_info;

static_assert(static_cast<int>(StatusCode::kOk) == REEB_OK);
static_assert(static_cast<int>(StatusCode::kInvalidArgument) == REEB_INVALID_ARGUMENT);
static_assert(static_cast<int>(StatusCode::kCorrupt) == REEB_CORRUPT);
static_assert(static_cast<int>(StatusCode::kTruncated) == REEB_TRUNCATED);
static_assert(static_cast<int>(StatusCode::kUnsupported) == REEB_UNSUPPORTED);
static_assert(static_cast<int>(StatusCode::kLimitExceeded) == REEB_LIMIT_EXCEEDED);
static_assert(static_cast<int>(StatusCode::kIo) == REEB_IO);
static_assert(static_cast<int>(StatusCode::kCancelled) == REEB_CANCELLED);
static_assert(static_cast<int>(StatusCode::kOutOfMemory) == REEB_OUT_OF_MEMORY);
static_assert(static_cast<int>(StatusCode::kNeedMoreData) == REEB_NEED_MORE_DATA);

void* allocate_plainly(void*, size_t size) { return std::malloc(size); }
void release_plainly(void*, void* block) { std::free(block); }

class CallbackSource : public reeb::ByteSource {
 public:
  explicit CallbackSource(const reeb_reader& reader) : reader_(reader) {}
  uint64_t size() const override { return reader_.size; }
  Status read(uint64_t offset, size_t count, std::vector<uint8_t>& buffer,
              std::span<const uint8_t>& out) override {
    buffer.resize(count);
    if (count > 0 && reader_.read_at(reader_.user, offset, buffer.data(), count) != 0)
      return Status::io("the callback could not read " + std::to_string(count) +
                        " bytes from byte " + std::to_string(offset));
    out = buffer;
    return {};
  }

 private:
  reeb_reader reader_;
};

void destroy(reeb_decoder* decoder) {
  const reeb_allocator allocator = decoder->options.allocator;
  decoder->~reeb_decoder();
  allocator.release(allocator.user, decoder);
}

reeb_decoder* create(const reeb_options& options) {
  void* const block = options.allocator.allocate(options.allocator.user, sizeof(reeb_decoder));
  return block == nullptr ? nullptr : new (block) reeb_decoder(options);
}

/// Where a failed opening is told, since there will be no handle.
class OpenReport {
 public:
  explicit OpenReport(const reeb_options& options) : options_(options) { copy(""); }

  reeb_result failed(reeb_result result, const char* why) const {
    if (options_.log != nullptr) options_.log(options_.log_user, REEB_LOG_ERROR, why);
    copy(why);
    return result;
  }

 private:
  void copy(const char* text) const {
    reeb_c::copy_text(text, options_.message, options_.message_size);
  }

  const reeb_options& options_;
};

/// Makes a handle and has `open` fill it. Members of the options are checked here. `wrong`: what is
/// with the other arguments; NULL where nothing is.
template <class Open>
reeb_result open_with(const reeb_options* options, reeb_decoder** out, const char* wrong,
                      Open&& open) {
  if (out != nullptr) *out = nullptr;
  reeb_options own = {};
  if (options != nullptr && !adopt(options, own)) return REEB_INVALID_ARGUMENT;
  const OpenReport report(own);
  if (out == nullptr) wrong = "no place for the decoder";
  if (own.allocator.allocate == nullptr)
    own.allocator = {allocate_plainly, release_plainly, nullptr};
  if (own.allocator.release == nullptr) wrong = "an allocator without release";
  if (wrong != nullptr) return report.failed(REEB_INVALID_ARGUMENT, wrong);
  reeb_decoder* const handle = create(own);
  if (handle == nullptr) return report.failed(REEB_OUT_OF_MEMORY, "out of memory");
  Status status;
  try {
    status = open(handle->decode_options(), handle->decoder);
  } catch (const std::bad_alloc&) {
    status = Status::out_of_memory();
  }
  if (status.ok()) {
    handle->warn_of_damage();
    *out = handle;
    return REEB_OK;
  }
  destroy(handle);
  return report.failed(static_cast<reeb_result>(status.code()), status.message().c_str());
}

reeb_info describe(const reeb::StreamInfo& info) {
  reeb_info out = {};
  out.format_version = info.format_version;
  out.frame_count = info.frame_count;
  out.total_frames = info.total_frames;
  out.shot_count = static_cast<uint32_t>(info.shots.size());
  out.group_count = static_cast<uint32_t>(info.groups.size());
  out.metadata_count = static_cast<uint32_t>(info.metadata.size());
  out.gap_count = static_cast<uint32_t>(info.missing.size());
  for (const auto& shot : info.shots)
    out.max_vertices = std::max(out.max_vertices, shot.vertex_count);
  out.truncated = info.truncated;
  out.frame_rate = info.frame_rate;
  out.start_time = info.start_time;
  out.file_bytes = info.file_bytes;
  return out;
}

/// One past the last frame that the groups of a shot hold.
uint32_t end_of_shot(const reeb::StreamInfo& info, uint32_t shot) {
  const uint32_t first = info.shots[shot].first_frame;
  const uint32_t next =
      shot + 1 < info.shots.size() ? info.shots[shot + 1].first_frame : UINT32_MAX;
  uint32_t end = first;
  for (const auto& g : info.groups) {
    if (g.first_frame >= first && g.first_frame < next) end = g.first_frame + g.frame_count;
  }
  return end;
}

}  // namespace

const char* reeb_result_string(int result) {
  switch (result) {
    case REEB_OK:
      return "ok";
    case REEB_INVALID_ARGUMENT:
      return "invalid argument";
    case REEB_CORRUPT:
      return "corrupt";
    case REEB_TRUNCATED:
      return "truncated";
    case REEB_UNSUPPORTED:
      return "unsupported";
    case REEB_LIMIT_EXCEEDED:
      return "limit exceeded";
    case REEB_IO:
      return "input failed";
    case REEB_CANCELLED:
      return "cancelled";
    case REEB_OUT_OF_MEMORY:
      return "out of memory";
    case REEB_NEED_MORE_DATA:
      return "more data needed";
  }
  return "unknown result";
}

uint32_t reeb_version(void) {
  return REEB_VERSION_MAJOR * 1000000u + REEB_VERSION_MINOR * 1000u + REEB_VERSION_PATCH;
}
const char* reeb_version_string(void) { return REEB_VERSION_STRING; }
uint32_t reeb_format_version(void) { return reeb::kFormatVersion; }

reeb_result reeb_probe(const void* bytes, size_t size) {
  if (bytes == nullptr && size > 0) return REEB_INVALID_ARGUMENT;
  const size_t known = std::min(size, reeb::kSignature.size());
  if (known > 0 && std::memcmp(bytes, reeb::kSignature.data(), known) != 0) return REEB_CORRUPT;
  if (size < reeb::kPreambleBytes) return REEB_NEED_MORE_DATA;
  const uint8_t version = static_cast<const uint8_t*>(bytes)[reeb::kSignature.size()];
  return version == reeb::kFormatVersion ? REEB_OK : REEB_UNSUPPORTED;
}

reeb_result reeb_open_memory(const void* bytes, size_t size, const reeb_options* options,
                             reeb_decoder** decoder) {
  const char* const wrong = bytes == nullptr && size > 0 ? "no bytes" : nullptr;
  return open_with(options, decoder, wrong, [&](const reeb::DecodeOptions& o, auto& out) {
    return reeb::Decoder::open(std::span(static_cast<const uint8_t*>(bytes), size), o, out);
  });
}

reeb_result reeb_open_reader(const reeb_reader* reader, const reeb_options* options,
                             reeb_decoder** decoder) {
  const bool readable = reader != nullptr && reader->read_at != nullptr;
  return open_with(options, decoder, readable ? nullptr : "no reader",
                   [&](const reeb::DecodeOptions& o, auto& out) {
                     return reeb::Decoder::open(std::make_unique<CallbackSource>(*reader), o, out);
                   });
}

reeb_result reeb_open_push(const reeb_options* options, reeb_decoder** decoder) {
  return open_with(options, decoder, nullptr, [&](const reeb::DecodeOptions& o, auto& out) {
    return reeb::Decoder::open_pushed(o, out);
  });
}

reeb_result reeb_push(reeb_decoder* d, const void* bytes, size_t size) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  if (bytes == nullptr && size > 0) return d->invalid("no bytes");
  const std::lock_guard lock(d->info_mutex);
  return d->done(d->decoder->push(std::span(static_cast<const uint8_t*>(bytes), size)));
}

reeb_result reeb_push_end(reeb_decoder* d) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  const std::lock_guard lock(d->info_mutex);
  const reeb_result result = d->done(d->decoder->finish());
  if (result == REEB_OK) d->warn_of_damage();
  return result;
}

void reeb_close(reeb_decoder* d) {
  if (d != nullptr) destroy(d);
}

reeb_result reeb_get_info(reeb_decoder* d, reeb_info* out) {
  return with_info(d, [&](const reeb::StreamInfo& info) { return give(describe(info), out); });
}

reeb_result reeb_get_shot(reeb_decoder* d, uint32_t shot, reeb_shot* out) {
  return with_info(d, [&](const reeb::StreamInfo& info) {
    if (shot >= info.shots.size()) return REEB_INVALID_ARGUMENT;
    const auto& s = info.shots[shot];
    return give({0, s.first_frame, s.frame_count, s.vertex_count, s.face_count,
                 s.order_kept ? 1 : 0, end_of_shot(info, shot)},
                out);
  });
}

reeb_result reeb_get_group(reeb_decoder* d, uint32_t group, reeb_group* out) {
  return with_info(d, [&](const reeb::StreamInfo& info) {
    if (group >= info.groups.size()) return REEB_INVALID_ARGUMENT;
    const auto& g = info.groups[group];
    return give(
        {0, g.first_frame, g.frame_count, g.shot, g.component_count, g.region_count, g.bytes}, out);
  });
}

reeb_result reeb_get_gap(reeb_decoder* d, uint32_t gap, uint32_t* first_frame,
                         uint32_t* frame_count) {
  return with_info(d, [&](const reeb::StreamInfo& info) {
    if (gap >= info.missing.size() || first_frame == nullptr || frame_count == nullptr)
      return REEB_INVALID_ARGUMENT;
    *first_frame = info.missing[gap].first_frame;
    *frame_count = info.missing[gap].frame_count;
    return REEB_OK;
  });
}

reeb_result reeb_get_metadata(reeb_decoder* d, uint32_t index, const char** key,
                              const char** value) {
  return with_info(d, [&](const reeb::StreamInfo& info) {
    if (index >= info.metadata.size() || key == nullptr || value == nullptr)
      return REEB_INVALID_ARGUMENT;
    *key = info.metadata[index].first.c_str();
    *value = info.metadata[index].second.c_str();
    return REEB_OK;
  });
}

const char* reeb_find_metadata(reeb_decoder* d, const char* key) {
  const char* found = nullptr;
  if (key == nullptr) return found;
  (void)with_info(d, [&](const reeb::StreamInfo& info) {
    for (const auto& [k, value] : info.metadata) {
      if (k == key) found = value.c_str();
    }
    return REEB_OK;
  });
  return found;
}

reeb_result reeb_get_triangles(reeb_decoder* d, uint32_t frame, const uint32_t** indices,
                               size_t* triangle_count) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  if (indices == nullptr || triangle_count == nullptr) return d->invalid("no place for triangles");
  std::span<const uint32_t> triangles;
  const reeb_result result = d->done(d->decoder->triangles(frame, triangles));
  *indices = triangles.data();
  *triangle_count = triangles.size() / 3;
  return result;
}

reeb_result reeb_get_polygons(reeb_decoder* d, uint32_t frame, const uint32_t** face_sizes,
                              size_t* face_count, const uint32_t** corners, size_t* corner_count) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  const reeb::Connectivity* c = nullptr;
  const reeb_result result = d->done(d->decoder->connectivity(frame, c));
  if (result != REEB_OK) return result;
  if (face_sizes != nullptr) *face_sizes = c->face_sizes.data();
  if (face_count != nullptr) *face_count = c->face_sizes.size();
  if (corners != nullptr) *corners = c->corners.data();
  if (corner_count != nullptr) *corner_count = c->corners.size();
  return result;
}

reeb_result reeb_get_frame(reeb_decoder* d, uint32_t frame, const reeb_target* target) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  reeb::FrameTarget own;
  if (!make_target(target, own)) return d->invalid("no target, or one without its struct_size");
  return d->done(d->decoder->decode_frame(frame, own));
}

reeb_result reeb_get_between(reeb_decoder* d, double position, const reeb_target* target) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  reeb::FrameTarget own;
  if (!make_target(target, own)) return d->invalid("no target, or one without its struct_size");
  return d->done(d->decoder->decode_at(position, own));
}

reeb_result reeb_position_of_time(reeb_decoder* d, double seconds, int loop, double* position) {
  const reeb::FloatState state;
  return with_info(d, [&](const reeb::StreamInfo& info) {
    const double frames = info.frame_count;
    const double at = seconds * info.frame_rate;
    if (position == nullptr || frames == 0 || !(info.frame_rate > 0) || !std::isfinite(at))
      return REEB_INVALID_ARGUMENT;
    const double turned = loop != 0 ? at - frames * std::floor(at / frames) : at;
    *position = std::max(0.0, std::min(turned, frames - 1));
    return REEB_OK;
  });
}

void reeb_set_loop(reeb_decoder* d, int loop) {
  if (d != nullptr) d->decoder->set_loop(loop != 0);
}

void reeb_cancel(reeb_decoder* d) {
  if (d != nullptr) d->decoder->cancel();
}

reeb_result reeb_get_stats(reeb_decoder* d, reeb_stats* out) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  const reeb::DecodeStats s = d->decoder->stats();
  return give({0, s.frames, s.groups_decoded, s.groups_ahead, s.longest_stall,
               s.longest_stall_frame, s.memory, s.peak_memory},
              out);
}

void reeb_reset_stats(reeb_decoder* d) {
  if (d != nullptr) d->decoder->reset_stats();
}

size_t reeb_get_message(reeb_decoder* d, char* buffer, size_t size) {
  if (d == nullptr) return 0;
  const std::lock_guard lock(d->message_mutex);
  reeb_c::copy_text(d->message, buffer, size);
  return d->message.size();
}
