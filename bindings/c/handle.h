// The handle of the C interface, and how its functions deal with the caller's structs.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <new>
#include <string>
#include <string_view>

#include "codec/dec/decoder.h"
#include "reeb.h"

namespace reeb_c {

/// The caller's allocator as the decoder wants it.
class CallerMemory : public std::pmr::memory_resource {
 public:
  explicit CallerMemory(const reeb_allocator& allocator) : allocator_(allocator) {}

 private:
  void* do_allocate(size_t bytes, size_t) override {
    void* const block = allocator_.allocate(allocator_.user, bytes > 0 ? bytes : 1);
    if (block == nullptr) throw std::bad_alloc();
    return block;
  }
  void do_deallocate(void* block, size_t, size_t) override {
    allocator_.release(allocator_.user, block);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  reeb_allocator allocator_;
};

/// The caller's struct, members it does not know as 0; false where its size makes no sense.
template <class Struct>
bool adopt(const Struct* in, Struct& out) {
  if (in == nullptr || in->struct_size < sizeof in->struct_size) return false;
  out = {};
  std::memcpy(&out, in, std::min(in->struct_size, sizeof out));
  return true;
}

/// Fills as much of the caller's struct as it knows of.
template <class Struct>
reeb_result give(Struct from, Struct* out) {
  if (out == nullptr || out->struct_size < sizeof out->struct_size) return REEB_INVALID_ARGUMENT;
  from.struct_size = out->struct_size;
  std::memcpy(out, &from, std::min(out->struct_size, sizeof from));
  return REEB_OK;
}

/// Copies text, cut to `size` bytes with its closing 0.
inline void copy_text(std::string_view text, char* buffer, size_t size) {
  if (buffer == nullptr || size == 0) return;
  const size_t count = std::min(size - 1, text.size());
  std::memcpy(buffer, text.data(), count);
  buffer[count] = '\0';
}

template <class T>
T or_default(T value, T standard) {
  return value != 0 ? value : standard;
}

}  // namespace reeb_c

struct reeb_decoder {
  explicit reeb_decoder(const reeb_options& o) : options(o), memory(o.allocator) {}

  reeb_options options;
  reeb_c::CallerMemory memory;
  std::unique_ptr<reeb::Decoder> decoder;
  std::mutex info_mutex;  ///< of the decoder's info, which pushing changes
  std::mutex message_mutex;
  std::string message;

  reeb::DecodeOptions decode_options() {
    const reeb::Limits standard;
    const reeb_limits& l = options.limits;
    reeb::DecodeOptions out;
    out.limits = {.max_vertices = reeb_c::or_default(l.max_vertices, standard.max_vertices),
                  .max_faces = reeb_c::or_default(l.max_faces, standard.max_faces),
                  .max_frames = reeb_c::or_default(l.max_frames, standard.max_frames),
                  .max_memory = reeb_c::or_default(l.max_memory, standard.max_memory)};
    out.threads = reeb_c::or_default(options.threads, 1u);
    out.prefetch = options.prefetch != 0;
    out.cache_bytes = reeb_c::or_default(options.cache_bytes, out.cache_bytes);
    out.memory = &memory;
    return out;
  }

  void say(reeb_log_level level, const char* text) const {
    if (options.log != nullptr) options.log(options.log_user, level, text);
  }

  /// Keeps the message of a failure.
  reeb_result done(const reeb::Status& status) {
    if (status.ok()) return REEB_OK;
    say(REEB_LOG_ERROR, status.message().c_str());
    try {
      const std::lock_guard lock(message_mutex);
      message = status.message();
    } catch (const std::bad_alloc&) {  // the message before stays
    }
    return static_cast<reeb_result>(status.code());
  }
  reeb_result invalid(const char* what) {
    try {
      return done(reeb::Status::invalid(what));
    } catch (const std::bad_alloc&) {
      return REEB_INVALID_ARGUMENT;
    }
  }

  void warn_of_damage() const {
    const reeb::StreamInfo& info = decoder->info();
    if (info.truncated) say(REEB_LOG_WARNING, "the file ends early");
    if (!info.missing.empty()) say(REEB_LOG_WARNING, "some frames are damaged or cut off");
  }
};

namespace reeb_c {

/// Calls `function` with the info at rest; no info before the sequence header is there.
template <class Function>
reeb_result with_info(reeb_decoder* d, Function&& function) {
  if (d == nullptr) return REEB_INVALID_ARGUMENT;
  const std::lock_guard lock(d->info_mutex);
  const reeb::StreamInfo& info = d->decoder->info();
  return info.format_version == 0 ? REEB_NEED_MORE_DATA : function(info);
}

inline bool make_target(const reeb_target* in, reeb::FrameTarget& out) {
  reeb_target own = {};
  if (!adopt(in, own)) return false;
  out = {.positions = own.positions,
         .stride = or_default<size_t>(own.position_stride, 3),
         .normals = own.normals,
         .normal_stride = or_default<size_t>(own.normal_stride, 3),
         .vertex_capacity = own.vertex_capacity};
  return true;
}

}  // namespace reeb_c
