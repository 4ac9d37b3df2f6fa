#include "bindings/python/src/stream.h"

#include <cstring>
#include <filesystem>
#include <fstream>

namespace reeb_python {

bool in_main_thread() {
  static const auto main_thread = nb::cast<unsigned long>(
      nb::module_::import_("threading").attr("main_thread")().attr("ident"));
  return PyThread_get_thread_ident() == main_thread;
}

/// A Python object that is read from. What it raises is kept for the call that it ends.
class FileObject {
 public:
  explicit FileObject(nb::object file) : file_(std::move(file)) {}
  FileObject(const FileObject&) = delete;
  FileObject& operator=(const FileObject&) = delete;
  ~FileObject() {
    const nb::gil_scoped_acquire lock;  // a thread of the library may be the last to know it
    file_.reset();
    raised_.reset();
  }

  bool read(uint64_t offset, void* buffer, size_t size) {
    const nb::gil_scoped_acquire lock;
    try {
      file_.attr("seek")(offset);
      for (size_t done = 0; done < size;) {
        const auto piece = nb::cast<nb::bytes>(file_.attr("read")(size - done));
        if (piece.size() == 0 || piece.size() > size - done) return false;
        std::memcpy(static_cast<char*>(buffer) + done, piece.c_str(), piece.size());
        done += piece.size();
      }
      return true;
    } catch (nb::python_error& error) {
      raised_ = nb::borrow(error.value());
    } catch (const std::exception&) {  // read gave something else than bytes
    }
    return false;
  }

  /// What was raised last, once.
  nb::object take_raised() { return std::move(raised_); }

 private:
  nb::object file_;
  nb::object raised_;
};

Stream::Stream(std::string name, const OpenOptions& o)
    : name_(std::move(name)), options_(reeb::Stream::defaults()) {
  options_.threads = o.threads;
  options_.prefetch = o.prefetch ? 1 : 0;
  options_.cache_bytes = o.cache_bytes;
  options_.limits.max_memory = o.max_memory;
}

template <class Open>
void Stream::open(Open&& open) {
  const auto stream = std::make_shared<reeb::Stream>();
  reeb_result result;
  {
    const nb::gil_scoped_release release;
    result = open(*stream);
  }
  check(result, *stream);
  stream_ = stream;
}

void Stream::open_path(const std::string& path) {
  const auto file =
      std::make_shared<std::ifstream>(std::filesystem::u8path(path), std::ios::binary);
  file->seekg(0, std::ios::end);
  const auto size = static_cast<std::streamoff>(file->tellg());
  if (!*file || size < 0) throw Failure{REEB_IO, name_ + ": cannot be read"};
  open([&](reeb::Stream& stream) {
    return stream.open_reader(
        static_cast<uint64_t>(size),
        [file](uint64_t offset, void* buffer, size_t count) {
          file->clear();
          file->seekg(static_cast<std::streamoff>(offset));
          file->read(static_cast<char*>(buffer), static_cast<std::streamsize>(count));
          return static_cast<bool>(*file);
        },
        options_);
  });
}

void Stream::open_bytes(nb::bytes bytes) {
  open([&](reeb::Stream& stream) {
    return stream.open_memory(bytes.c_str(), bytes.size(), options_);
  });
  bytes_ = std::move(bytes);
}

void Stream::open_file(nb::object file, uint64_t size) {
  file_ = std::make_shared<FileObject>(std::move(file));
  open([&](reeb::Stream& stream) {
    return stream.open_reader(
        size,
        [file = file_](uint64_t offset, void* buffer, size_t count) {
          return file->read(offset, buffer, count);
        },
        options_);
  });
}

void Stream::close() {
  if (!stream_) return;
  stream_->cancel();
  std::shared_ptr<reeb::Stream> last = std::move(stream_);
  const nb::gil_scoped_release
      release;  // the thread that decodes ahead may be reading a file object
  last.reset();
}

std::shared_ptr<reeb::Stream> Stream::get() const {
  if (!stream_) throw Failure{REEB_INVALID_ARGUMENT, name_ + " is closed"};
  return stream_;
}

void Stream::check(reeb_result result, const reeb::Stream& stream) const {
  if (result == REEB_OK) return;
  if (result == REEB_IO && file_ != nullptr) {
    if (nb::object raised = file_->take_raised(); raised.is_valid()) {
      PyErr_SetObject(raised.type().ptr(), raised.ptr());
      throw nb::python_error();
    }
  }
  std::string message = stream.message();
  if (message.empty()) message = reeb_result_string(result);
  throw Failure{result, name_ + ": " + message};
}

bool Stream::same_group(uint32_t frame) {
  if (frame >= group_first_ && frame < group_end_) return true;
  const uint32_t count = stream_->info().group_count;
  for (uint32_t g = 0; g < count; ++g) {
    const reeb_group group = stream_->group(g);
    if (frame < group.first_frame || frame - group.first_frame >= group.frame_count) continue;
    group_first_ = group.first_frame;
    group_end_ = group.first_frame + group.frame_count;
    break;
  }
  return false;
}

}  // namespace reeb_python
