// An open stream as Python holds it.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <memory>
#include <string>

#include "bindings/python/src/errors.h"
#include "bindings/python/src/job.h"
#include "reeb.hpp"

namespace reeb_python {

/// Arrays that values are written to: contiguous, of the caller.
using Positions = nb::ndarray<float, nb::ndim<2>, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using FramePositions =
    nb::ndarray<float, nb::ndim<3>, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using Bytes = nb::ndarray<uint8_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

struct OpenOptions {
  unsigned threads = 1;
  bool prefetch = true;
  uint64_t cache_bytes = 0, max_memory = 0;
};

/// The functions of the library on one stream, as exceptions and without the interpreter's lock.
/// Whoever calls keeps the stream alive, so that `close` may come at any time from any thread.
class Stream {
 public:
  /// `name` starts the messages of errors.
  Stream(std::string name, const OpenOptions& options);
  ~Stream() { close(); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  void open_path(const std::string& path);
  void open_bytes(nb::bytes bytes);
  /// An object with `seek` and `readinto` or `read`.
  void open_file(nb::object file, uint64_t size);
  void close();
  bool closed() const { return stream_ == nullptr; }

  /// Throws where it is closed.
  std::shared_ptr<reeb::Stream> get() const;
  const std::string& name() const { return name_; }

  /// Calls `function(stream)`, which gives a reeb_result, for something of `frame`.
  template <class Function>
  void call(uint32_t frame, Function&& function) {
    const std::shared_ptr<reeb::Stream> stream = get();
    const bool direct = same_group(frame) || !in_main_thread();
    reeb_result result;
    if (direct) {
      const nb::gil_scoped_release release;
      result = function(*stream);
    } else {
      result = run_job([&] { return function(*stream); }, [&] { stream->cancel(); }, [] {});
    }
    check(result, *stream);
  }
  void check(reeb_result result, const reeb::Stream& stream) const;

 private:
  template <class Open>
  void open(Open&& open);
  /// True where `frame` is of the group that the call before was about, which is at hand.
  bool same_group(uint32_t frame);

  std::string name_;
  reeb_options options_;
  std::shared_ptr<reeb::Stream> stream_;
  std::shared_ptr<class FileObject> file_;
  nb::object bytes_;
  uint32_t group_first_ = 0, group_end_ = 0;
};

}  // namespace reeb_python
