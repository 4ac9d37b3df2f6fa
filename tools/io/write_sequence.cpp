#include "tools/io/write_sequence.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <utility>

#include "tools/io/attribute_values.h"
#include "tools/io/frame_list.h"
#include "tools/io/gather_attributes.h"
#include "tools/io/material_files.h"
#include "tools/io/mesh_file.h"
#include "tools/io/output_set.h"
#include "tools/io/point_cache.h"
#include "tools/io/standard_output.h"
#include "tools/parallel.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

struct PendingFrame {
  fs::path target;
  SourceFrame frame;
  std::vector<std::string> unkept;
  Status status;
};

/// What is not written, told once.
class Unwritten {
 public:
  Unwritten(std::string output, std::vector<std::string>* notes)
      : output_(std::move(output)), notes_(notes) {}

  void add(const std::vector<std::string>& names) { names_.insert(names.begin(), names.end()); }
  void finish(const std::string& why) {
    if (names_.empty() || notes_ == nullptr) return;
    std::string list;
    for (const std::string& name : names_) list += (list.empty() ? "" : ", ") + name;
    notes_->push_back(output_ + ": " + why + ": " + list);
  }

 private:
  const std::string output_;
  std::vector<std::string>* notes_;
  std::set<std::string> names_;
};

/// One mesh file per frame: formatted on several threads, a batch at a time.
Status write_frames(const FrameSource& source, const std::vector<fs::path>& targets,
                    MeshFormat format, const std::string& output, const WriteOptions& options,
                    OutputSet& files) {
  Unwritten unwritten(output, options.notes);
  const size_t batch = size_t{4} * thread_count(options.threads);
  for (size_t first = 0; first < targets.size(); first += batch) {
    std::vector<PendingFrame> pending(std::min(batch, targets.size() - first));
    for (size_t i = 0; i < pending.size(); ++i) {
      PendingFrame& p = pending[i];
      p.target = targets[first + i];
      Status status = source.frame(static_cast<uint32_t>(first + i), p.frame);
      if (!status.ok()) return status;
    }
    parallel_for(pending.size(), options.threads, [&](size_t i) {
      PendingFrame& p = pending[i];
      const SourceFrame& f = p.frame;
      p.status = files.write(
          p.target, write_mesh(*f.connectivity, f.positions, format, f.attributes, &p.unkept));
    });
    for (const PendingFrame& p : pending) {
      if (!p.status.ok()) return p.status;
      unwritten.add(p.unkept);
    }
    if (options.progress) {
      options.progress(static_cast<double>(first + pending.size()) /
                       static_cast<double>(targets.size()));
    }
  }
  unwritten.finish("not written, for which the format has no place");
  return {};
}

Status check_same_mesh(const Connectivity& first, const Connectivity& now, uint32_t number,
                       const fs::path& cache) {
  if (&first == &now || first == now) return {};
  return Status::invalid(cache.string() +
                         ": a point cache holds one connectivity, which changes at "
                         "frame " +
                         grouped(number) +
                         "; write one file per frame (e.g. frame_%04d.obj) or pick --frames");
}

/// Names of the attributes that have other values now.
std::vector<std::string> changed(const SourceFrame& first, const SourceFrame& now) {
  std::vector<std::string> out;
  for (size_t i = 0; i < now.attributes.size() && i < first.attributes.size(); ++i) {
    if (now.attributes[i].values != first.attributes[i].values)
      out.push_back(now.attributes[i].name);
  }
  return out;
}

/// `mesh`: where the faces and attributes go; empty for nowhere.
Status write_cache(const FrameSource& source, const fs::path& cache, CacheFormat format,
                   const fs::path& mesh, const WriteOptions& options, OutputSet& files) {
  const auto count = static_cast<uint32_t>(source.numbers.size());
  Unwritten unwritten(cache.string(), options.notes);
  Unwritten changing(cache.string(), options.notes);
  SourceFrame first;
  SourceFrame now;
  for (uint32_t i = 0; i < count; ++i) {
    Status status = source.frame(i, now);
    if (!status.ok()) return status;
    if (i == 0) {
      first = now;
      std::vector<std::string> unkept;
      if (mesh.empty())
        list_unwritten(first.attributes, {}, &unkept);
      else
        status = files.write(mesh, write_mesh(*first.connectivity, first.positions,
                                              MeshFormat::kObj, first.attributes, &unkept));
      unwritten.add(unkept);
      if (!status.ok()) return status;
      status = files.write(
          cache, cache_header(format, first.connectivity->vertex_count, count, source.frame_rate,
                              source.start_time, source.frames_per_sample));
    } else {
      status = check_same_mesh(*first.connectivity, *now.connectivity, source.numbers[i], cache);
      if (!mesh.empty()) changing.add(changed(first, now));
    }
    if (status.ok()) status = files.write(cache, cache_positions(format, now.positions));
    if (!status.ok()) return status;
    if (options.progress) options.progress(static_cast<double>(i + 1) / count);
  }
  unwritten.finish("not written, for which it has no place");
  changing.finish("changes over time, " + mesh.string() + " has it as in the first frame");
  return {};
}

/// Files that meshes name, and where they go.
class ResourceFiles {
 public:
  /// `mesh`: beside it; empty for nowhere.
  ResourceFiles(const FrameSource& source, const fs::path& mesh, const std::string& output,
                const WriteOptions& options) {
    Unwritten unwritten(output, options.notes);
    for (const Resource& r : source.resources) {
      if (!mesh.empty() && may_lie_beside(r.name))
        files_.emplace_back(mesh.parent_path() / r.name, &r);
      else
        unwritten.add({r.name});
    }
    unwritten.finish("files that are not written");
  }

  void announce(std::vector<fs::path>& targets) const {
    for (const auto& [target, resource] : files_) targets.push_back(target);
  }
  Status write(OutputSet& files) const {
    for (const auto& [target, resource] : files_) {
      const auto* bytes = reinterpret_cast<const char*>(resource->bytes.data());
      Status status = files.write(target, {bytes, resource->bytes.size()});
      if (!status.ok()) return status;
    }
    return {};
  }

 private:
  std::vector<std::pair<fs::path, const Resource*>> files_;
};

Status unknown_format(const std::string& output) {
  return Status::invalid(output +
                         ": cannot tell the format; end the name in .obj, .ply, .off, .stl, "
                         ".pc2 or .mdd");
}

Status one_frame(const std::string& output, uint32_t frame_count) {
  const fs::path path(output);
  const fs::path stem = path.parent_path() / path.stem();
  std::string remedy = "pick one by --frames or take --format pc2";
  if (path.has_extension()) {
    remedy = "name " + stem.string() + "_%04d" + path.extension().string() + " or " +
             stem.string() + ".pc2";
  }
  return Status::invalid(output + " holds one frame, there are " + grouped(frame_count) + "; " +
                         remedy);
}

}  // namespace

FrameSource source_of(const Sequence& sequence) {
  FrameSource source;
  source.frame_rate = sequence.frame_rate;
  for (const Shot& shot : sequence.shots)
    source.least_bytes += 12 * uint64_t{shot.frame_count} * shot.connectivity.vertex_count;
  source.start_time = sequence.start_time;
  const auto rate = sequence.metadata.find(kSampleRateKey);
  if (rate != sequence.metadata.end()) {
    source.frames_per_sample = std::strtod(rate->second.c_str(), nullptr);
  }
  for (uint32_t i = 0; i < sequence.frame_count(); ++i) source.numbers.push_back(i + 1);
  source.resources = sequence.resources;
  source.frame = [&sequence](uint32_t i, SourceFrame& out) {
    for (const Shot& shot : sequence.shots) {
      if (i < shot.frame_count) {
        out.connectivity = &shot.connectivity;
        const auto frame = shot.frame(i);
        out.positions.assign(frame.begin(), frame.end());
        out.attributes = attributes_of_frame(shot.attributes, shot.frame_count, i);
        return Status();
      }
      i -= shot.frame_count;
    }
    return Status::invalid("no such frame");
  };
  return source;
}

Status parse_output_name(const std::string& output, uint32_t frame_count, const std::string& format,
                         OutputName& out) {
  using Kind = OutputName::Kind;
  std::error_code ignored;
  const fs::file_status status = fs::status(output, ignored);
  const std::string wanted = format.empty() ? "" : "." + format;
  if (is_standard_output(output) || (fs::exists(status) && fs::is_other(status))) {
    const std::string extension = !wanted.empty() ? wanted : frame_count == 1 ? ".obj" : ".pc2";
    const bool cache = cache_format("x" + extension).has_value();
    out = {cache ? Kind::kCache : Kind::kSingleMesh, output, extension};
    return cache || frame_count == 1 ? Status() : one_frame(output, frame_count);
  }
  NumberPattern numbers;
  const bool numbered = NumberPattern::parse(output, numbers);
  const std::string extension = fs::path(output).extension().string();
  if (fs::is_directory(status) || output.ends_with('/') || (extension.empty() && !numbered)) {
    const std::string inside = wanted.empty() ? ".obj" : wanted;
    if (!mesh_format("x" + inside)) {
      return Status::invalid(output + ": a folder holds a mesh per frame; name a file, as in " +
                             (fs::path(output) / ("out" + inside)).string());
    }
    out = {Kind::kFrames, (fs::path(output) / ("frame_%04d" + inside)).string(), inside};
    return {};
  }
  if (!wanted.empty() && mesh_format(output) != mesh_format("x" + wanted)) {
    return Status::invalid(output + ": its ending says another format than --format " + format);
  }
  out = {Kind::kFrames, output, extension};
  if (cache_format(output)) {
    out.kind = Kind::kCache;
    out.faces_beside = true;
    return {};
  }
  if (!mesh_format(output)) return unknown_format(output);
  if (numbered) return {};
  out.kind = Kind::kSingleMesh;
  return frame_count == 1 ? Status() : one_frame(output, frame_count);
}

Status write_sequence(const FrameSource& source, const std::string& output,
                      const WriteOptions& options) {
  OutputName name;
  const auto count = static_cast<uint32_t>(source.numbers.size());
  if (count == 0) return Status::invalid("there are no frames to write");
  if (Status status = parse_output_name(output, count, options.format, name); !status.ok())
    return status;
  const auto cache = cache_format("x" + name.extension);
  if (cache == CacheFormat::kMdd && !(source.frame_rate > 0)) {
    return Status::invalid(output +
                           ": an MDD holds times and the frame rate is not known; give it "
                           "by --fps, or write a .pc2");
  }

  std::vector<fs::path> targets;
  NumberPattern numbers;
  if (name.kind == OutputName::Kind::kFrames && NumberPattern::parse(name.pattern, numbers)) {
    for (const uint32_t number : source.numbers) targets.emplace_back(numbers.name(number));
  } else {
    targets.emplace_back(name.pattern);
  }
  if (name.faces_beside) targets.push_back(fs::path(name.pattern).replace_extension(".obj"));

  OutputSet files(options.overwrite);
  Status status = check_room(targets[0], source.least_bytes);
  const fs::path mesh = name.faces_beside ? targets[1]
                        : !cache && name.extension == ".obj" && !is_standard_output(output)
                            ? targets[0]
                            : fs::path();
  const ResourceFiles resources(source, mesh, output, options);
  std::vector<fs::path> all = targets;
  resources.announce(all);
  if (status.ok()) status = files.prepare(all);
  if (status.ok()) status = resources.write(files);
  if (!status.ok()) return status;
  if (cache) {
    status = write_cache(source, targets[0], *cache, mesh, options, files);
  } else {
    status =
        write_frames(source, targets, *mesh_format("x" + name.extension), output, options, files);
  }
  return status.ok() ? files.commit() : status;
}

}  // namespace reeb::tools
