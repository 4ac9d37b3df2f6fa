// Files that appear together or not at all.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <string_view>
#include <vector>

#include "bitstream/status.h"

namespace reeb::tools {

/// Writes files under temporary names beside their targets and gives them their names in `commit`,
/// all or, where one cannot get it, none: then what was there before is put back. What is not
/// committed is removed with the set, together with the folders it created; `abandon_all` does the
/// same for every living set, for use on the way out of an interrupted program. One set is used by
/// one thread except for `write`, which any number of threads may call.
///
/// Temporary names cannot be foreseen, and no links that someone puts in their place are followed.
/// A target that exists and is no regular file (/dev/null, a pipe) is written directly, and so is
/// standard output ("-", "/dev/stdout"); one that is a link stays one.
class OutputSet {
 public:
  explicit OutputSet(bool overwrite) : overwrite_(overwrite) {}
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;

  /// Announces targets, before the work that makes them: fails where one exists and may not be
  /// overwritten, creates their folders, and begins the first file of each to see whether it can
  /// be written.
  Status prepare(const std::vector<std::filesystem::path>& targets);

  /// Writes, or continues, the file that will be `target`, a path given to `prepare` before.
  Status write(const std::filesystem::path& target, std::string_view bytes);

  /// Gives all files their names.
  Status commit();

  /// Removes what all living sets have written so far, and blocks every later use of them.
  static void abandon_all();

 private:
  struct File {
    std::filesystem::path target;
    std::filesystem::path real;     ///< the target behind links
    std::filesystem::path written;  ///< the temporary name; `real` where it is written directly
    std::filesystem::path before;   ///< while committing: what `real` was, under another name
    bool started = false;
    dev_t device = 0;  ///< of what was created as `written`
    ino_t inode = 0;
  };
  Status create_folder(const std::filesystem::path& folder);
  Status begin_files();
  File* find(const std::filesystem::path& target);
  Status open(File& file, int& descriptor) const;
  Status place(File& file) const;
  static void take_back(const File& file);
  static bool is_written(const File& file, const struct stat& now);
  static Status replaced(const File& file);
  void discard();

  bool overwrite_;
  std::vector<File> files_;
  std::vector<std::filesystem::path> created_folders_;  ///< outermost first
};

/// Why `target` must not be written; ok where it may.
Status check_target(const std::filesystem::path& target, bool overwrite);

/// Fails where the file system that `target` will be on has fewer than `bytes` bytes left.
Status check_room(const std::filesystem::path& target, uint64_t bytes);

}  // namespace reeb::tools
