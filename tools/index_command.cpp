#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>

#include "codec/dec/decoder.h"
#include "tools/archive/shape_archive.h"
#include "tools/archive/shape_source.h"
#include "tools/archive_command.h"
#include "tools/io/file_bytes.h"
#include "tools/io/output_set.h"
#include "tools/io/read_sequence.h"
#include "tools/parallel.h"
#include "tools/text.h"

namespace reeb::tools {
namespace index_command {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kSaveInterval{20};

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  uint32_t poses = 3;
  unsigned threads = 0;
  uint64_t max_memory = Limits().max_memory;
  ConsoleOptions console;
};

// What `reeb encode --signature` left in a stream, which is not decoded for it.
bool stored_in(const fs::path& path, std::vector<SignedFrame>& frames) {
  if (path.extension() != ".reeb") return false;
  FileBytes bytes;
  if (!FileBytes::read(path, bytes).ok()) return false;
  const std::span<const uint8_t> stream(reinterpret_cast<const uint8_t*>(bytes.view().data()),
                                        bytes.view().size());
  std::unique_ptr<Decoder> decoder;
  if (!Decoder::open(stream, {}, decoder).ok()) return false;
  for (const auto& [key, value] : decoder->info().metadata) {
    if (key == kSignatureKey && parse_stored(value, frames)) return true;
  }
  frames.clear();
  return false;
}

// Signs files and keeps the archive on disc up to date meanwhile, so that little is lost when the
// command is stopped.
class Indexer {
 public:
  Indexer(const Options& options, Console& console) : options_(options), console_(console) {}

  Status run() {
    std::error_code error;
    if (fs::exists(options_.output, error)) {
      ShapeArchive before;
      if (Status status = read_archive(options_.output, before); !status.ok()) return status;
      for (ArchivedFile& file : before.files) files_[file.path] = std::move(file);
    }
    std::vector<fs::path> paths;
    if (Status status = find_shape_files(options_.inputs, paths); !status.ok()) return status;
    std::vector<ArchivedFile> todo = files_to_sign(paths);
    const auto bar = console_.bar("signing");
    std::atomic<size_t> done{0};
    last_save_ = std::chrono::steady_clock::now();
    parallel_for(todo.size(), options_.threads, [&](size_t i) {
      const Status status = sign_file(todo[i]);
      const std::lock_guard lock(mutex_);
      finish(todo[i], status);
      if (bar) bar(static_cast<double>(++done) / static_cast<double>(todo.size()));
    });
    if (!save_status_.ok()) return save_status_;
    if (Status status = save(); !status.ok()) return status;
    size_t shapes = 0;
    for (const auto& [path, file] : files_) shapes += file.shapes.size();
    console_.say(options_.output + ": " + counted(files_.size(), "file") + ", " +
                 counted(shapes, "shape") + "; " + grouped(signed_) + " signed now, " +
                 grouped(paths.size() - todo.size()) + " unchanged, " + grouped(failed_) +
                 " failed");
    if (failed_ > 0) return Status::corrupt(counted(failed_, "file") + " could not be signed");
    return {};
  }

 private:
  std::vector<ArchivedFile> files_to_sign(const std::vector<fs::path>& paths) const {
    std::vector<ArchivedFile> todo;
    for (const fs::path& path : paths) {
      std::error_code error;
      ArchivedFile file{path.string(),
                        fs::file_size(path, error),
                        fs::last_write_time(path, error).time_since_epoch().count(),
                        {}};
      const auto known = files_.find(file.path);
      const bool same = known != files_.end() && known->second.size == file.size &&
                        known->second.modified == file.modified;
      if (!same) todo.push_back(std::move(file));
    }
    return todo;
  }

  Status sign_file(ArchivedFile& file) const {
    if (stored_in(file.path, file.shapes)) return {};
    Sequence sequence;
    ReadReport report;
    Status status = read_sequence({file.path}, {.threads = 1, .max_memory = options_.max_memory},
                                  sequence, report);
    if (!status.ok()) return status;
    std::string complaint;
    file.shapes = sign_frames(sequence, options_.poses, complaint);
    return file.shapes.empty() ? Status::invalid(file.path + ": " + complaint) : Status();
  }

  void finish(ArchivedFile& file, const Status& status) {
    if (status.ok()) {
      ++signed_;
      files_[file.path] = std::move(file);
    } else {
      ++failed_;
      console_.error(status.message());
    }
    const auto now = std::chrono::steady_clock::now();
    if (now - last_save_ < kSaveInterval) return;
    last_save_ = now;
    if (Status saved = save(); !saved.ok()) save_status_ = saved;
  }

  Status save() const {
    ShapeArchive archive;
    for (const auto& [path, file] : files_) archive.files.push_back(file);
    OutputSet output(true);
    Status status = output.prepare({options_.output});
    if (status.ok())
      status = output.write(options_.output, write_archive(archive, options_.output));
    if (status.ok()) status = output.commit();
    return status;
  }

  const Options& options_;
  Console& console_;
  std::map<std::string, ArchivedFile> files_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point last_save_;
  Status save_status_;
  size_t signed_ = 0, failed_ = 0;
};

int run(const Options& o) {
  Console console(o.console);
  const std::string extension = fs::path(o.output).extension().string();
  if (extension != ".json" && extension != ".reebi") {
    console.error(o.output + " does not end in .json or .reebi");
    return kExitUsage;
  }
  const Status status = Indexer(o, console).run();
  return status.ok() ? kExitDone : fail(console, status);
}

}  // namespace
}  // namespace index_command

void add_index_command(CLI::App& app, int& exit_code) {
  using namespace index_command;
  auto* command = app.add_subcommand("index", "Sign shapes, for reeb search to find them");
  auto o = std::make_shared<Options>();
  command
      ->add_option("INPUT", o->inputs,
                   "Folders, looked through with all below, or files: meshes (OBJ, PLY, OFF, STL), "
                   ".reeb files, point caches with their mesh beside them")
      ->required()
      ->type_name("");
  command
      ->add_option(
          "-o,--output", o->output,
          "The archive: .json, or .reebi, which is smaller. One that is there already "
          "is added to; files that have not changed are not signed again. It is kept up to "
          "date every 20 seconds: what is stopped goes on from there when run again")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--poses", o->poses,
                   "Frames signed of a sequence, spread over it, 1 to 1000; default 3")
      ->check(CLI::Range(1u, 1000u).description(""))
      ->type_name("N");
  add_threads_option(*command, o->threads);
  add_memory_limit_option(*command, o->max_memory);
  add_console_options(*command, o->console);
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace reeb::tools
