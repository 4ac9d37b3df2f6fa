#include "tools/io/output_set.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>
#include <random>
#include <string>

#include "tools/io/standard_output.h"
#include "tools/text.h"

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
  if (is_standard_output(path.string())) return true;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

/// A name beside `real` that nothing has yet, that nobody can foresee, and short enough whatever
/// the length of the target's.
fs::path fresh_name(const fs::path& real) {
  std::random_device random;
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), ".reeb-%08x%08x.tmp", random(), random());
  return real.parent_path() / name.data();
}

/// Creates a file under a name that nothing has, which `name` becomes.
int create(const fs::path& real, fs::path& name) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = fresh_name(real);
    const int descriptor =
        ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return true;
}

bool links_unknown() {
  return errno == EPERM || errno == ENOTSUP || errno == EOPNOTSUPP || errno == ENOSYS ||
         errno == EMLINK;
}

/// Gives `from` the name `to`, unless something has it.
bool move_to_free_name(const fs::path& from, const fs::path& to) {
  if (::link(from.c_str(), to.c_str()) == 0) return ::unlink(from.c_str()) == 0;
  if (!links_unknown()) return false;
  // A file system without hard links: no better than a look and a step.
  std::error_code failed;
  if (fs::exists(fs::symlink_status(to, failed))) {
    errno = EEXIST;
    return false;
  }
  return std::rename(from.c_str(), to.c_str()) == 0;
}

// As if the file with that name were written to: what may read it today may read it tomorrow.
void take_permissions(int descriptor, const fs::path& real) {
  struct stat before {};
  if (::stat(real.c_str(), &before) != 0 || !S_ISREG(before.st_mode)) return;
  mode_t mode = before.st_mode & 0777;
  if (::fchown(descriptor, static_cast<uid_t>(-1), before.st_gid) != 0) mode &= ~mode_t{070};
  ::fchmod(descriptor, mode | S_IRUSR | S_IWUSR);
}

// Behind symbolic links, so that the link stays and its file changes.
fs::path resolved(const fs::path& path) {
  if (is_standard_output(path.string())) return path;
  std::error_code failed;
  const fs::path real = fs::is_symlink(path, failed) ? fs::canonical(path, failed) : path;
  return failed ? path : real;
}

}  // namespace

Status check_target(const fs::path& target, bool overwrite) {
  std::error_code failed;
  const fs::file_status status = fs::status(target, failed);
  if (failed == std::errc::filename_too_long) {
    return Status::io(target.string() + ": cannot be written (" + failed.message() +
                      "); give it a shorter name");
  }
  if (is_special(target) && !fs::is_directory(status)) return {};
  if (fs::is_directory(status)) {
    return Status::io(target.string() + ": is a folder; name a file in it");
  }
  if (fs::is_regular_file(status) && !overwrite) {
    return Status::io(target.string() + ": exists already; pass -f to overwrite it");
  }
  // A new file could take its name, but whoever has protected it does not want that.
  if (fs::is_regular_file(status) && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) {
    return Status::io(target.string() + ": cannot be overwritten (" + std::strerror(errno) +
                      "); allow writing to it or name another file");
  }
  return {};
}

Status check_room(const fs::path& target, uint64_t bytes) {
  if (is_special(target)) return {};
  std::error_code failed;
  fs::path folder = fs::absolute(target, failed).parent_path();
  while (!failed && !folder.empty() && !fs::exists(folder, failed) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  const fs::space_info space = fs::space(folder, failed);
  if (failed || space.available >= bytes) return {};
  return Status::io(target.string() + ": needs " + byte_size(bytes) + " or more, and only " +
                    byte_size(space.available) + " are free; make room or name another folder");
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
    File file;
    file.target = target;
    file.real = resolved(target);
    if (is_special(file.real)) file.written = file.real;
    files_.push_back(std::move(file));
  }
  // Sorted, so that `find` stays quick with thousands of frames.
  std::sort(files_.begin(), files_.end(),
            [](const File& a, const File& b) { return a.target < b.target; });
  return begin_files();
}

// One in each folder.
Status OutputSet::begin_files() {
  std::optional<fs::path> begun;
  for (File& file : files_) {
    const fs::path here = file.target.parent_path();
    if (file.started || file.written == file.real || begun == here) continue;
    int descriptor = -1;
    Status status = open(file, descriptor);
    if (descriptor >= 0) ::close(descriptor);
    if (!status.ok()) return status;
    begun = here;
  }
  return {};
}

Status OutputSet::create_folder(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code failed;
  for (fs::path f = folder; !f.empty() && !fs::exists(f, failed); f = f.parent_path()) {
    missing.push_back(f);
  }
  for (auto f = missing.rbegin(); f != missing.rend(); ++f) {
    if (fs::create_directory(*f, failed)) created_folders_.push_back(*f);
    if (failed) {
      return Status::io(f->string() + ": cannot be created (" + failed.message() + ")");
    }
  }
  return {};
}

// A number of an inode may be given again, but not with this user's name on it to someone else.
bool OutputSet::is_written(const File& file, const struct stat& now) {
  return S_ISREG(now.st_mode) && now.st_nlink == 1 && now.st_uid == ::geteuid() &&
         file.device == now.st_dev && file.inode == now.st_ino;
}

Status OutputSet::replaced(const File& file) {
  return Status::io(file.target.string() + ": someone has replaced " + file.written.string() +
                    ", under which it is written; use a folder that is yours alone");
}

OutputSet::File* OutputSet::find(const fs::path& target) {
  const auto file = std::lower_bound(files_.begin(), files_.end(), target,
                                     [](const File& f, const fs::path& t) { return f.target < t; });
  return file != files_.end() && file->target == target ? &*file : nullptr;
}

// Creates the file, or opens it again: the very one that was created, not what has its name now.
Status OutputSet::open(File& file, int& descriptor) const {
  const bool special = file.written == file.real;
  if (!special && !file.started) {
    descriptor = create(file.real, file.written);
    if (descriptor >= 0) take_permissions(descriptor, file.real);
  } else {
    const int flags = special ? O_WRONLY | O_CLOEXEC : O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC;
    descriptor = ::open(file.written.c_str(), flags);
  }
  struct stat now {};
  if (descriptor < 0 || ::fstat(descriptor, &now) != 0) return write_failure(file.target);
  if (special) return {};
  if (!file.started) {
    file.device = now.st_dev;
    file.inode = now.st_ino;
    file.started = true;
  }
  return is_written(file, now) ? Status() : replaced(file);
}

Status OutputSet::write(const fs::path& target, std::string_view bytes) {
  if (is_standard_output(target.string())) return write_standard_output(bytes);
  int descriptor = -1;
  Status status;
  {
    const std::lock_guard lock(registry().mutex);
    File* const file = find(target);
    if (file == nullptr) return Status::invalid(target.string() + ": was not prepared");
    status = open(*file, descriptor);
  }
  if (status.ok() && !write_all(descriptor, bytes)) status = write_failure(target);
  if (descriptor >= 0 && ::close(descriptor) != 0 && status.ok()) status = write_failure(target);
  return status;
}

Status OutputSet::place(File& file) const {
  Status status = check_target(file.target, overwrite_);
  if (!status.ok()) return status;
  struct stat now {};
  if (::lstat(file.written.c_str(), &now) != 0) return write_failure(file.target);
  if (!is_written(file, now)) return replaced(file);
  std::error_code failed;
  if (!fs::exists(file.real, failed)) {
    if (move_to_free_name(file.written, file.real)) return {};
    status = errno == EEXIST ? check_target(file.target, false) : write_failure(file.target);
    return status.ok() ? write_failure(file.target) : status;
  }
  const fs::path before = fresh_name(file.real);
  const bool linked = ::link(file.real.c_str(), before.c_str()) == 0;
  const bool kept =
      linked || (links_unknown() && std::rename(file.real.c_str(), before.c_str()) == 0);
  if (kept && std::rename(file.written.c_str(), file.real.c_str()) == 0) {
    file.before = before;
    return {};
  }
  status = write_failure(file.target);
  if (linked) fs::remove(before, failed);
  if (kept && !linked) fs::rename(before, file.real, failed);
  return status;
}

void OutputSet::take_back(const File& file) {
  std::error_code ignored;
  if (file.before.empty()) {
    fs::remove(file.real, ignored);
  } else {
    fs::rename(file.before, file.real, ignored);
  }
}

Status OutputSet::commit() {
  const std::lock_guard lock(registry().mutex);
  std::vector<File*> placed;
  for (File& file : files_) {
    if (!file.started) continue;
    Status status = place(file);
    if (!status.ok()) {
      for (const File* p : placed) take_back(*p);
      return status;
    }
    file.started = false;
    placed.push_back(&file);
  }
  std::error_code ignored;
  for (const File* p : placed) {
    if (!p->before.empty()) fs::remove(p->before, ignored);
  }
  created_folders_.clear();
  return {};
}

void OutputSet::discard() {
  std::error_code ignored;
  for (File& file : files_) {
    if (file.started) fs::remove(file.written, ignored);
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
