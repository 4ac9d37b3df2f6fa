#include "tools/io/read_sequence.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "tools/io/file_bytes.h"
#include "tools/io/frame_list.h"
#include "tools/io/gather_attributes.h"
#include "tools/io/material_files.h"
#include "tools/io/mesh_file.h"
#include "tools/io/obj_faces.h"
#include "tools/io/point_cache.h"
#include "tools/metrics.h"
#include "tools/parallel.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

/// One frame on its way from a file to a shot.
struct Slot {
  Status status;
  FileBytes bytes;  ///< `mesh.face_text` points here
  MeshFrame mesh;
};

void read_frame(const fs::path& path, const MeshReference* reference, bool list_order, Slot& slot) {
  slot.status = FileBytes::read(path, slot.bytes);
  if (!slot.status.ok()) return;
  slot.status = read_mesh(slot.bytes.view(), *mesh_format(path), reference, slot.mesh);
  if (!slot.status.ok()) {
    slot.status = Status(slot.status.code(), path.string() + ": " + slot.status.message());
    return;
  }
  MeshFrame& mesh = slot.mesh;
  if (list_order && mesh.obj_faces)
    add_list_order(*mesh.obj_faces,
                   mesh.same_connectivity ? reference->connectivity : mesh.connectivity,
                   mesh.attributes);
}

/// What is to be said of frames, told once where they have it alike.
class FrameNotes {
 public:
  explicit FrameNotes(std::vector<std::string>& notes) : notes_(notes) {}

  void add(const MeshFrame& mesh, const std::string& name) {
    std::string names;
    for (const Unkept& u : mesh.unkept) {
      if (!told_.insert(u.name).second) continue;
      names += (names.empty() ? "" : ", ") + u.name + " (" + grouped(u.count) + ")";
    }
    if (!names.empty()) {
      notes_.push_back(name + ": not kept: " + names);
    }
    if (mesh.notes.empty() || ++odd_files_ > 1) return;
    for (const std::string& note : mesh.notes) notes_.emplace_back(name).append(": ").append(note);
  }

  void finish() {
    if (odd_files_ < 2) return;
    notes_.push_back("the same or the like in " + counted(odd_files_ - 1, "further file"));
  }

 private:
  std::vector<std::string>& notes_;
  std::set<std::string> told_;  ///< names of what is not kept
  size_t odd_files_ = 0;        ///< files with notes of their own
};

/// Gathers what binary32 does not hold.
class RemainderList {
 public:
  explicit RemainderList(ReadReport& report) : report_(report) {}

  /// Before the positions of `mesh` go to the last shot of `sequence`.
  void add(const MeshFrame& mesh, const Sequence& sequence, const std::string& name) {
    if (mesh.remainders.empty()) return;
    report_.remainders.resize(sequence.shots.size());
    auto& shot = report_.remainders.back();
    shot.resize(sequence.shots.back().positions.size());
    shot.insert(shot.end(), mesh.remainders.begin(), mesh.remainders.end());
    for (const float x : mesh.remainders) {
      if (std::abs(double{x}) <= report_.largest_remainder) continue;
      report_.largest_remainder = std::abs(double{x});
      largest_in_ = name;
    }
  }

  void finish(const Sequence& sequence) {
    if (report_.remainders.empty()) return;
    report_.remainders.resize(sequence.shots.size());
    for (size_t i = 0; i < sequence.shots.size(); ++i) {
      auto& shot = report_.remainders[i];
      if (!shot.empty()) shot.resize(sequence.shots[i].positions.size());
    }
    const double diagonal = bounding_diagonal(sequence);
    const double relative = diagonal > 0 ? report_.largest_remainder / diagonal : 1;
    report_.notes.push_back(largest_in_ +
                            ": binary32 does not hold the positions as they are written; they are "
                            "rounded, by up to " +
                            brief(report_.largest_remainder) + " (" + brief(100 * relative) +
                            " % of the diagonal)" + (relative > kFarRounding ? kNearer : ""));
  }

 private:
  static constexpr double kFarRounding = 1e-6;
  static constexpr const char* kNearer =
      "; subtract an offset from all frames, so that they lie nearer to the origin";

  ReadReport& report_;
  std::string largest_in_;  ///< the file
};

/// Reads files in batches on several threads and strings them into shots.
class FrameReader {
 public:
  FrameReader(const std::vector<fs::path>& files, const ReadOptions& options, Sequence& out,
              ReadReport& report)
      : files_(files),
        options_(options),
        out_(out),
        report_(report),
        notes_(report.notes),
        remainders_(report) {}

  Status run() {
    // The first frame alone, so that all others have a reference to be compared with.
    Status status = read_batch(0, 1);
    const size_t batch = size_t{8} * thread_count(options_.threads);
    for (size_t first = 1; first < files_.size() && status.ok(); first += batch) {
      status = read_batch(first, std::min(batch, files_.size() - first));
    }
    if (!status.ok()) return status;
    notes_.finish();
    remainders_.finish(out_);
    if (options_.list_order) {
      for (Shot& shot : out_.shots) drop_plain_orders(shot);
    }
    return {};
  }

 private:
  Status read_batch(size_t first, size_t count) {
    std::vector<Slot> slots(count);
    const std::shared_ptr<const MeshReference> compared = reference_;
    parallel_for(count, options_.threads, [&](size_t i) {
      read_frame(files_[first + i], compared.get(), options_.list_order, slots[i]);
    });
    for (size_t i = 0; i < count; ++i) {
      if (!slots[i].status.ok()) return frame_failure(slots[i].status, first + i);
      append(slots[i].mesh, compared.get(), first + i);
      slots[i] = Slot();
    }
    if (options_.progress) {
      options_.progress(static_cast<double>(first + count) / static_cast<double>(files_.size()));
    }
    return {};
  }

  Status frame_failure(const Status& status, size_t frame) const {
    if (files_.size() == 1) return status;
    return {status.code(), "frame " + grouped(frame + 1) + ": " + status.message()};
  }

  // `compared` is the reference at the time of reading; an earlier frame of the batch may have
  // replaced it.
  void append(MeshFrame& mesh, const MeshReference* compared, size_t frame) {
    const std::string what = difference(mesh, compared);
    if (!reference_ || !what.empty()) start_shot(mesh, compared, what, frame);
    Shot& shot = out_.shots.back();
    notes_.add(mesh, files_[frame].string());
    remainders_.add(mesh, out_, files_[frame].string());
    if (frame == 0) shot.positions.reserve(files_.size() * mesh.positions.size());
    shot.positions.insert(shot.positions.end(), mesh.positions.begin(), mesh.positions.end());
    append_attributes(std::move(mesh.attributes), shot.frame_count, shot.attributes);
    ++shot.frame_count;
  }

  // What keeps a frame from being one of the last shot; empty: nothing, or there is none.
  std::string difference(MeshFrame& mesh, const MeshReference* compared) const {
    if (!reference_) return {};
    if (!mesh.same_connectivity || compared != reference_.get()) {
      if (mesh.same_connectivity) mesh.connectivity = compared->connectivity;
      mesh.same_connectivity = false;
      if (mesh.connectivity != reference_->connectivity) return difference(mesh.connectivity);
    }
    return attribute_difference(out_.shots.back().attributes, mesh.attributes);
  }

  void start_shot(MeshFrame& mesh, const MeshReference* compared, const std::string& what,
                  size_t frame) {
    const std::string name = files_[frame].string();
    if (reference_) report_.notes.push_back(name + ": " + what + "; a new reference starts here");
    if (mesh.same_connectivity) mesh.connectivity = compared->connectivity;
    reference_ = std::make_shared<MeshReference>(
        MeshReference{mesh.connectivity, std::string(mesh.face_text), mesh.obj_faces});
    first_of_shot_ = frame;
    out_.shots.emplace_back().connectivity = std::move(mesh.connectivity);
  }

  std::string difference(const Connectivity& now) const {
    const Connectivity& before = reference_->connectivity;
    const std::string where = ", frame " + grouped(first_of_shot_ + 1) + " has ";
    if (now.vertex_count != before.vertex_count) {
      return counted(now.vertex_count, "vertex") + where + grouped(before.vertex_count);
    }
    if (now.face_sizes.size() != before.face_sizes.size()) {
      return counted(now.face_sizes.size(), "face") + where + grouped(before.face_sizes.size());
    }
    return "the faces differ from frame " + grouped(first_of_shot_ + 1);
  }

  const std::vector<fs::path>& files_;
  const ReadOptions& options_;
  Sequence& out_;
  ReadReport& report_;
  FrameNotes notes_;
  RemainderList remainders_;
  std::shared_ptr<const MeshReference> reference_;  ///< of the current shot
  size_t first_of_shot_ = 0;
};

Status read_cached(const InputFiles& input, const ReadOptions& options, Sequence& out,
                   ReadReport& report) {
  Slot slot;
  read_frame(input.meshes[0], nullptr, options.list_order, slot);
  if (!slot.status.ok()) return slot.status;
  PointCache cache;
  if (Status status = read_point_cache(input.cache, cache, options.progress); !status.ok())
    return status;
  if (cache.point_count != slot.mesh.connectivity.vertex_count) {
    return Status::corrupt(input.cache.string() + ": " + counted(cache.point_count, "point") +
                           ", " + input.meshes[0].string() + " has " +
                           grouped(slot.mesh.connectivity.vertex_count) +
                           " vertices; name the mesh the cache was exported from");
  }
  Shot& shot = out.shots.emplace_back();
  shot.connectivity = std::move(slot.mesh.connectivity);
  shot.frame_count = cache.frame_count;
  shot.positions = std::move(cache.positions);
  shot.attributes = std::move(slot.mesh.attributes);
  if (options.list_order) drop_plain_orders(shot);
  out.frame_rate = cache.frame_rate;
  out.start_time = cache.start_time;
  if (cache.frames_per_sample != 1) {
    out.metadata[kSampleRateKey] = brief(cache.frames_per_sample, 9);
  }
  FrameNotes(report.notes).add(slot.mesh, input.meshes[0].string());
  report.notes.insert(report.notes.end(), cache.notes.begin(), cache.notes.end());
  return {};
}

Status read_stream(const fs::path& path, const ReadOptions& options, Sequence& out,
                   ReadReport& report) {
  FileBytes file;
  if (Status status = FileBytes::read(path, file); !status.ok()) return status;
  const std::string_view text = file.view();
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  DecodeOptions decode_options{.limits = {}, .threads = options.threads};
  decode_options.limits.max_memory = options.max_memory;
  std::unique_ptr<Decoder> decoder;
  Status status = Decoder::open(bytes, decode_options, decoder);
  if (status.ok()) {
    report.stream = decoder->info();
    status = decode_sequence(bytes, decode_options, out, &report.missing);
    const bool partly =
        status.code() == StatusCode::kTruncated || status.code() == StatusCode::kCorrupt;
    if (partly && !out.shots.empty()) status = {};
    if (partly && out.shots.empty())
      status = {status.code(), "no frame can be decoded: " + status.message()};
  }
  return status.ok() ? status : stream_failure(path.string(), status, options.max_memory);
}

}  // namespace

Status stream_failure(const std::string& name, const Status& status, uint64_t max_memory) {
  const bool memory = status.code() == StatusCode::kLimitExceeded &&
                      status.message().find("memory") != std::string::npos;
  std::string remedy;
  if (memory)
    remedy = ", which is " + grouped(max_memory) + " bytes; allow more with --memory-limit";
  return {status.code(), name + ": " + status.message() + remedy};
}

Status read_sequence(const std::vector<std::string>& inputs, const ReadOptions& options,
                     Sequence& out, ReadReport& report) {
  out = Sequence();
  InputFiles input;
  if (Status status = find_input(inputs, options.allow_gaps, input); !status.ok()) return status;
  report.notes = std::move(input.notes);
  if (!input.stream.empty()) return read_stream(input.stream, options, out, report);
  Status status = input.cache.empty() ? FrameReader(input.meshes, options, out, report).run()
                                      : read_cached(input, options, out, report);
  if (!status.ok() || !options.embed) return status;
  for (const Shot& shot : out.shots)
    add_material_files(input.meshes[0].parent_path(), shot, out.resources, report.notes);
  return {};
}

}  // namespace reeb::tools
