#include "tools/io/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace reeb::tools {

namespace fs = std::filesystem;

Status read_failure(const std::string& name) {
  return Status::io(name + ": cannot be read (" + std::strerror(errno) +
                    "); check the name and the permissions");
}

Status FileBytes::read(const fs::path& path, FileBytes& out) {
  if (path == "-") return out.read_stream(stdin, "standard input");
  std::error_code ignored;
  const uintmax_t size = fs::file_size(path, ignored);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) return read_failure(path.string());
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  // One byte more than announced, so that the end shows without growing the buffer.
  if (!ignored) out.grow(static_cast<size_t>(size) + 1);
  return out.read_stream(file.get(), path.string());
}

Status FileBytes::read_stream(std::FILE* file, const std::string& name) {
  size_ = 0;
  while (true) {
    if (size_ == capacity_) grow(std::max<size_t>(2 * capacity_, 65536));
    const size_t n = std::fread(data_.get() + size_, 1, capacity_ - size_, file);
    size_ += n;
    if (n == 0) break;
  }
  return std::ferror(file) ? read_failure(name) : Status();
}

void FileBytes::grow(size_t capacity) {
  auto larger = std::make_unique_for_overwrite<char[]>(capacity);
  if (size_ != 0) std::memcpy(larger.get(), data_.get(), size_);
  data_ = std::move(larger);
  capacity_ = capacity;
}

}  // namespace reeb::tools
