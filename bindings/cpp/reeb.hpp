/**
 * @file reeb.hpp
 * The decoder for C++17: a thin owner around the C library of reeb.h, which says what everything
 * does. Nothing here throws but std::bad_alloc of the vectors and the function it is given.
 */
#ifndef REEB_HPP
#define REEB_HPP

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "reeb.h"

namespace reeb {

/** Numbers that live as long as the stream. */
struct IndexView {
  const uint32_t* data = nullptr;
  size_t size = 0;
  const uint32_t* begin() const { return data; }
  const uint32_t* end() const { return data + size; }
  uint32_t operator[](size_t i) const { return data[i]; }
};

/** Room for a frame of `vertices` vertices in vectors, which take that size; `normals` may be NULL.
 */
inline reeb_target target_in(std::vector<float>& positions, std::vector<float>* normals,
                             size_t vertices) {
  positions.resize(3 * vertices);
  if (normals != nullptr) normals->resize(3 * vertices);
  reeb_target target = {};
  target.struct_size = sizeof target;
  target.positions = positions.data();
  target.normals = normals != nullptr ? normals->data() : nullptr;
  target.vertex_capacity = vertices;
  return target;
}

/** An open stream, closed at the end of its life. Calls but the opening ones need an open one;
 * threads as of reeb_decoder, and nothing else runs while a stream is moved, swapped or closed. A
 * moved-from stream is closed. */
class Stream {
 public:
  Stream() = default;
  Stream(Stream&& other) noexcept = default;
  /** What was open here closes, after the threads that use its reader have ended. */
  Stream& operator=(Stream&& other) noexcept {
    Stream taken(std::move(other));
    swap(taken);
    return *this;
  }
  void swap(Stream& other) noexcept {
    read_at_.swap(other.read_at_);
    decoder_.swap(other.decoder_);
    open_message_.swap(other.open_message_);
  }
  friend void swap(Stream& a, Stream& b) noexcept { a.swap(b); }

  /** Copies `size` bytes from `offset` on; false where that fails. */
  using ReadAt = std::function<bool(uint64_t offset, void* buffer, size_t size)>;

  /** Options with every default. */
  static reeb_options defaults() {
    reeb_options options = {};
    options.struct_size = sizeof options;
    return options;
  }

  [[nodiscard]] reeb_result open_memory(const void* bytes, size_t size,
                                        const reeb_options& options = defaults()) {
    close();
    return adopt(options, [&](const reeb_options* o, reeb_decoder** out) {
      return reeb_open_memory(bytes, size, o, out);
    });
  }
  [[nodiscard]] reeb_result open_reader(uint64_t size, ReadAt read_at,
                                        const reeb_options& options = defaults()) {
    close();
    read_at_ = std::make_unique<ReadAt>(std::move(read_at));
    const reeb_reader reader = {size, *read_at_ ? call_read_at : nullptr, read_at_.get()};
    return adopt(options, [&](const reeb_options* o, reeb_decoder** out) {
      return reeb_open_reader(&reader, o, out);
    });
  }
  [[nodiscard]] reeb_result open_push(const reeb_options& options = defaults()) {
    close();
    return adopt(options,
                 [](const reeb_options* o, reeb_decoder** out) { return reeb_open_push(o, out); });
  }
  [[nodiscard]] reeb_result push(const void* bytes, size_t size) {
    return reeb_push(get(), bytes, size);
  }
  [[nodiscard]] reeb_result push_end() { return reeb_push_end(get()); }

  void close() {
    decoder_.reset();
    read_at_.reset();
  }
  explicit operator bool() const { return decoder_ != nullptr; }
  /** For the functions of reeb.h. */
  reeb_decoder* get() const { return decoder_.get(); }

  /** All 0 before the sequence header is there. */
  reeb_info info() const { return ask<reeb_info>(reeb_get_info); }
  reeb_shot shot(uint32_t index) const { return ask<reeb_shot>(reeb_get_shot, index); }
  reeb_group group(uint32_t index) const { return ask<reeb_group>(reeb_get_group, index); }
  reeb_stats stats() const { return ask<reeb_stats>(reeb_get_stats); }
  /** Empty where the key is not there. */
  std::string metadata(const char* key) const {
    const char* value = reeb_find_metadata(get(), key);
    return value != nullptr ? value : "";
  }

  [[nodiscard]] reeb_result triangles(uint32_t frame, IndexView& out) const {
    const reeb_result result = reeb_get_triangles(get(), frame, &out.data, &out.size);
    out.size *= 3;
    return result;
  }
  [[nodiscard]] reeb_result polygons(uint32_t frame, IndexView& sizes, IndexView& corners) const {
    return reeb_get_polygons(get(), frame, &sizes.data, &sizes.size, &corners.data, &corners.size);
  }

  /** Three floats a vertex; the vectors get room for the largest shot of the stream, and what is
   * beyond the frame's own vertices has no meaning. */
  [[nodiscard]] reeb_result frame(uint32_t frame, std::vector<float>& positions,
                                  std::vector<float>* normals = nullptr) {
    return fill(positions, normals,
                [&](const reeb_target& target) { return reeb_get_frame(get(), frame, &target); });
  }
  /** The pose at a position in frames. */
  [[nodiscard]] reeb_result between(double position, std::vector<float>& positions,
                                    std::vector<float>* normals = nullptr) {
    return fill(positions, normals, [&](const reeb_target& target) {
      return reeb_get_between(get(), position, &target);
    });
  }
  /** A position in frames for `between`; 0 where the frame rate is unknown. */
  double position_of_time(double seconds, bool loop) const {
    double position = 0;
    (void)reeb_position_of_time(get(), seconds, loop ? 1 : 0, &position);
    return position;
  }

  void set_loop(bool loop) { reeb_set_loop(get(), loop ? 1 : 0); }
  void cancel() { reeb_cancel(get()); }
  void reset_stats() { reeb_reset_stats(get()); }
  /** About the last call that failed, the opening one included. */
  std::string message() const {
    if (!decoder_) return open_message_;
    std::string text(reeb_get_message(get(), nullptr, 0), '\0');
    text.resize(std::min(text.size(), reeb_get_message(get(), text.data(), text.size() + 1)));
    return text;
  }

 private:
  struct Close {
    void operator()(reeb_decoder* decoder) const { reeb_close(decoder); }
  };

  static int call_read_at(void* user, uint64_t offset, void* buffer, size_t size) {
    return (*static_cast<ReadAt*>(user))(offset, buffer, size) ? 0 : 1;
  }

  template <class Open>
  reeb_result adopt(reeb_options options, Open&& open) {
    char text[256] = "";
    const bool own = options.message == nullptr;
    if (own) {
      options.message = text;
      options.message_size = sizeof text;
    }
    reeb_decoder* decoder = nullptr;
    const reeb_result result = open(&options, &decoder);
    decoder_.reset(decoder);
    open_message_ = own || options.message_size > 0 ? options.message : "";
    return result;
  }

  template <class Struct, class Function, class... Index>
  Struct ask(Function function, Index... index) const {
    Struct out = {};
    out.struct_size = sizeof out;
    (void)function(get(), index..., &out);
    return out;
  }

  template <class Decode>
  reeb_result fill(std::vector<float>& positions, std::vector<float>* normals, Decode&& decode) {
    return decode(target_in(positions, normals, info().max_vertices));
  }

  std::unique_ptr<ReadAt> read_at_;  // outlives the decoder
  std::unique_ptr<reeb_decoder, Close> decoder_;
  std::string open_message_;
};

}  // namespace reeb

#endif
