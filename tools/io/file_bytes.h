// A whole file in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

#include "bitstream/status.h"

namespace reeb::tools {

class FileBytes {
 public:
  /// Reads the file at `path`; "-" is standard input. The message of a failure names the file.
  static Status read(const std::filesystem::path& path, FileBytes& out);

  std::string_view view() const { return {data_.get(), size_}; }

 private:
  Status read_stream(std::FILE* file, const std::string& name);
  void grow(size_t capacity);

  std::unique_ptr<char[]> data_;
  size_t size_ = 0;
  size_t capacity_ = 0;
};

/// "NAME: cannot be read (REASON)", the reason from errno.
Status read_failure(const std::string& name);

}  // namespace reeb::tools
