#include "tools/io/output_set.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

/// Living sets. Whoever changes what is on disk holds the mutex, so that an interruption finds
/// either all temporary names or all final ones.
struct Registry {
  std::recursive_mutex mutex;
  std::vector<OutputSet*> sets;
};

Registry& registry() {
  static Registry instance;
  return instance;
}

Status write_failure(const fs::path& target) {
  return Status::io(target.string() + ": cannot be written (" + std::strerror(errno) + ")");
}

bool is_special(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

fs::path temporary_name(const fs::path& target) {
  std::string name(1, '.');
  name += target.filename().string() + ".reeb-" + std::to_string(::getpid()) + ".tmp";
  return target.parent_path() / name;
}

// Behind symbolic links, so that the link stays and its file changes.
fs::path resolved(const fs::path& path) {
  std::error_code failed;
  const fs::path real = fs::is_symlink(path, failed) ? fs::canonical(path, failed) : path;
  return failed ? path : real;
}

}  // namespace

Status check_target(const fs::path& target, bool overwrite) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) {
    return Status::io(target.string() + ": is a folder; name a file in it");
  }
  if (fs::is_regular_file(status) && !overwrite) {
    return Status::io(target.string() + ": exists already; pass -f to overwrite it");
  }
  return {};
}

OutputSet::~OutputSet() {
  const std::lock_guard lock(registry().mutex);
  discard();
  std::erase(registry().sets, this);
}

Status OutputSet::prepare(const std::vector<fs::path>& targets) {
  for (const fs::path& target : targets) {
    if (Status status = check_target(target, overwrite_); !status.ok()) return status;
  }
  const std::lock_guard lock(registry().mutex);
  if (std::count(registry().sets.begin(), registry().sets.end(), this) == 0) {
    registry().sets.push_back(this);
  }
  for (const fs::path& target : targets) {
    if (Status status = create_folder(target.parent_path()); !status.ok()) return status;
    const fs::path real = resolved(target);
    files_.push_back({target, is_special(real) ? real : temporary_name(real)});
  }
  // Sorted, so that `find` stays quick with thousands of frames.
  std::sort(files_.begin(), files_.end(),
            [](const File& a, const File& b) { return a.target < b.target; });
  return {};
}

Status OutputSet::create_folder(const fs::path& folder) {
  std::vector<fs::path> missing;
  for (fs::path f = folder; !f.empty() && !fs::exists(f); f = f.parent_path()) missing.push_back(f);
  for (auto f = missing.rbegin(); f != missing.rend(); ++f) {
    std::error_code failed;
    if (fs::create_directory(*f, failed)) created_folders_.push_back(*f);
    if (failed) {
      return Status::io(f->string() + ": cannot be created (" + failed.message() + ")");
    }
  }
  return {};
}

OutputSet::File* OutputSet::find(const fs::path& target) {
  const auto file = std::lower_bound(files_.begin(), files_.end(), target,
                                     [](const File& f, const fs::path& t) { return f.target < t; });
  return file != files_.end() && file->target == target ? &*file : nullptr;
}

Status OutputSet::write(const fs::path& target, std::string_view bytes) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(nullptr, std::fclose);
  {
    const std::lock_guard lock(registry().mutex);
    File* const file = find(target);
    if (file == nullptr) return Status::invalid(target.string() + ": was not prepared");
    stream.reset(std::fopen(file->written.c_str(), file->started ? "ab" : "wb"));
    if (!stream) return write_failure(target);
    file->started = true;
  }
  const size_t written = std::fwrite(bytes.data(), 1, bytes.size(), stream.get());
  if (written != bytes.size() || std::fclose(stream.release()) != 0) return write_failure(target);
  return {};
}

Status OutputSet::commit() {
  const std::lock_guard lock(registry().mutex);
  for (File& file : files_) {
    if (!file.started) continue;
    const fs::path real = resolved(file.target);
    if (file.written != real) {
      Status status = check_target(file.target, overwrite_);
      if (status.ok() && std::rename(file.written.c_str(), real.c_str()) != 0) {
        status = write_failure(file.target);
      }
      if (!status.ok()) return status;
    }
    file.started = false;
  }
  created_folders_.clear();
  return {};
}

void OutputSet::discard() {
  std::error_code ignored;
  for (File& file : files_) {
    if (file.started && !is_special(file.written)) fs::remove(file.written, ignored);
    file.started = false;
  }
  // Only empty folders go: what someone else has put there stays.
  for (auto f = created_folders_.rbegin(); f != created_folders_.rend(); ++f) {
    fs::remove(*f, ignored);
  }
  created_folders_.clear();
}

void OutputSet::abandon_all() {
  registry().mutex.lock();  // never released: nothing may be written any more
  for (OutputSet* const set : registry().sets) set->discard();
}

}  // namespace reeb::tools
