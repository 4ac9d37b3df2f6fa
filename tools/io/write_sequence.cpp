#include "tools/io/write_sequence.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tools/io/frame_list.h"
#include "tools/io/mesh_file.h"
#include "tools/io/output_set.h"
#include "tools/io/point_cache.h"
#include "tools/parallel.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

namespace fs = std::filesystem;

struct PendingFrame {
  fs::path target;
  const Connectivity* connectivity = nullptr;
  std::vector<float> positions;
  Status status;
};

/// One mesh file per frame: formatted on several threads, a batch at a time.
Status write_frames(const FrameSource& source, const std::vector<fs::path>& targets,
                    const WriteOptions& options, OutputSet& files) {
  const MeshFormat format = *mesh_format(targets[0]);
  const size_t batch = size_t{4} * thread_count(options.threads);
  for (size_t first = 0; first < targets.size(); first += batch) {
    std::vector<PendingFrame> pending(std::min(batch, targets.size() - first));
    for (size_t i = 0; i < pending.size(); ++i) {
      PendingFrame& p = pending[i];
      p.target = targets[first + i];
      const Status status =
          source.frame(static_cast<uint32_t>(first + i), p.connectivity, p.positions);
      if (!status.ok()) return status;
    }
    parallel_for(pending.size(), options.threads, [&](size_t i) {
      PendingFrame& p = pending[i];
      p.status = files.write(p.target, write_mesh(*p.connectivity, p.positions, format));
    });
    for (const PendingFrame& p : pending) {
      if (!p.status.ok()) return p.status;
    }
    if (options.progress) {
      options.progress(static_cast<double>(first + pending.size()) /
                       static_cast<double>(targets.size()));
    }
  }
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

Status write_cache(const FrameSource& source, const fs::path& cache, const fs::path& mesh,
                   const WriteOptions& options, OutputSet& files) {
  const CacheFormat format = *cache_format(cache);
  const auto count = static_cast<uint32_t>(source.numbers.size());
  const Connectivity* first = nullptr;
  const Connectivity* now = nullptr;
  std::vector<float> positions;
  for (uint32_t i = 0; i < count; ++i) {
    Status status = source.frame(i, now, positions);
    if (!status.ok()) return status;
    if (i == 0) {
      first = now;
      status = files.write(mesh, write_mesh(*first, positions, MeshFormat::kObj));
      if (!status.ok()) return status;
      status =
          files.write(cache, cache_header(format, first->vertex_count, count, source.frame_rate,
                                          source.start_time, source.frames_per_sample));
    } else {
      status = check_same_mesh(*first, *now, source.numbers[i], cache);
    }
    if (status.ok()) status = files.write(cache, cache_positions(format, positions));
    if (!status.ok()) return status;
    if (options.progress) options.progress(static_cast<double>(i + 1) / count);
  }
  return {};
}

Status unknown_format(const std::string& output) {
  return Status::invalid(output +
                         ": cannot tell the format; end the name in .obj, .ply, .off, .stl, "
                         ".pc2 or .mdd");
}

}  // namespace

FrameSource source_of(const Sequence& sequence) {
  FrameSource source;
  source.frame_rate = sequence.frame_rate;
  source.start_time = sequence.start_time;
  const auto rate = sequence.metadata.find(kSampleRateKey);
  if (rate != sequence.metadata.end()) {
    source.frames_per_sample = std::strtod(rate->second.c_str(), nullptr);
  }
  for (uint32_t i = 0; i < sequence.frame_count(); ++i) source.numbers.push_back(i + 1);
  source.frame = [&sequence](uint32_t i, const Connectivity*& connectivity,
                             std::vector<float>& positions) {
    for (const Shot& shot : sequence.shots) {
      if (i < shot.frame_count) {
        connectivity = &shot.connectivity;
        const auto frame = shot.frame(i);
        positions.assign(frame.begin(), frame.end());
        return Status();
      }
      i -= shot.frame_count;
    }
    return Status::invalid("no such frame");
  };
  return source;
}

Status parse_output_name(const std::string& output, uint32_t frame_count, OutputName& out) {
  NumberPattern numbers;
  if (fs::is_directory(output) || output.ends_with('/')) {
    out = {OutputName::Kind::kFrames, (fs::path(output) / "frame_%04d.obj").string()};
    return {};
  }
  if (cache_format(output)) {
    out = {OutputName::Kind::kCache, output};
    return {};
  }
  if (fs::path(output).extension().empty() && !NumberPattern::parse(output, numbers)) {
    out = {OutputName::Kind::kFrames, (fs::path(output) / "frame_%04d.obj").string()};
    return {};
  }
  if (!mesh_format(output)) return unknown_format(output);
  if (NumberPattern::parse(output, numbers)) {
    out = {OutputName::Kind::kFrames, output};
    return {};
  }
  if (frame_count == 1) {
    out = {OutputName::Kind::kSingleMesh, output};
    return {};
  }
  const fs::path path(output);
  const fs::path stem = path.parent_path() / path.stem();
  return Status::invalid(output + " holds one frame, there are " + grouped(frame_count) +
                         "; name " + stem.string() + "_%04d" + path.extension().string() + " or " +
                         stem.string() + ".pc2");
}

Status write_sequence(const FrameSource& source, const std::string& output,
                      const WriteOptions& options) {
  OutputName name;
  const auto count = static_cast<uint32_t>(source.numbers.size());
  if (count == 0) return Status::invalid("there are no frames to write");
  if (Status status = parse_output_name(output, count, name); !status.ok()) return status;

  std::vector<fs::path> targets;
  if (name.kind == OutputName::Kind::kFrames) {
    NumberPattern numbers;
    if (!NumberPattern::parse(name.pattern, numbers)) return unknown_format(output);
    for (const uint32_t number : source.numbers) targets.emplace_back(numbers.name(number));
  } else {
    targets.emplace_back(name.pattern);
  }
  const bool is_cache = name.kind == OutputName::Kind::kCache;
  if (is_cache) targets.push_back(fs::path(name.pattern).replace_extension(".obj"));

  OutputSet files(options.overwrite);
  Status status = files.prepare(targets);
  if (!status.ok()) return status;
  status = is_cache ? write_cache(source, targets[0], targets[1], options, files)
                    : write_frames(source, targets, options, files);
  return status.ok() ? files.commit() : status;
}

}  // namespace reeb::tools
