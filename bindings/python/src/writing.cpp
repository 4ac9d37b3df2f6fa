// Functions _core.encode and _core.report, class _core.LosslessWriter.
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <span>
#include <utility>

#include "bindings/python/src/errors.h"
#include "bindings/python/src/job.h"
#include "bindings/python/src/module.h"
#include "bindings/python/src/sequence_input.h"
#include "bitstream/container.h"
#include "codec/enc/encoder.h"
#include "codec/enc/lossless/lossless_sequence.h"
#include "codec/enc/lossless/stream_encoder.h"
#include "reeb.h"
#include "tools/encoding_report.h"

namespace reeb_python {
namespace {

using namespace nb::literals;
using reeb::EncodeOptions;
using reeb::EncodeStats;
using reeb::Status;
using reeb::Target;

void check(const Status& status) {
  if (!status.ok()) throw Failure{static_cast<int>(status.code()), status.message()};
}

Target target_of(const std::string& name) {
  if (name == "max_error") return Target::kMaxError;
  if (name == "bpvf") return Target::kBpvf;
  if (name == "size") return Target::kSize;
  return name == "lossless" ? Target::kLossless : Target::kKg;
}

reeb::Profile profile_of(const std::string& name) {
  if (name == "fast") return reeb::Profile::kFast;
  return name == "thesis" ? reeb::Profile::kThesis : reeb::Profile::kMain;
}

EncodeOptions options_of(const nb::dict& from) {
  EncodeOptions out;
  out.target = target_of(nb::cast<std::string>(from["target"]));
  if (out.target != Target::kLossless) out.target_value = nb::cast<double>(from["value"]);
  out.profile = profile_of(nb::cast<std::string>(from["profile"]));
  out.effort = nb::cast<int>(from["effort"]);
  out.group_length = nb::cast<uint32_t>(from["group_length"]);
  out.open_groups = nb::cast<int>(from["open_groups"]);
  out.reorder = nb::cast<bool>(from["reorder"]);
  out.regions = nb::cast<int>(from["regions"]);
  out.threads = nb::cast<unsigned>(from["threads"]);
  out.bounds = nb::cast<bool>(from["report"]);
  return out;
}

nb::dict figures(const EncodeStats& stats) {
  nb::dict out, sections;
  for (const auto& s : stats.sections) sections[s.name.c_str()] = static_cast<uint64_t>(s.bits / 8);
  out["bytes"] = stats.bytes;
  out["bpvf"] = stats.bpvf;
  out["kg"] = stats.kg;
  out["rmse"] = stats.rmse;
  out["max_error"] = stats.max_error;
  out["sections"] = sections;
  out["notes"] = nb::cast(stats.notes);
  return out;
}

/// How far a job is, between its thread and the caller's.
struct JobState {
  std::atomic<double> done{0};
  std::atomic<uint32_t> stop{0};
};

Status encode_with_report(reeb::Sequence& sequence, const EncodeOptions& options, bool report,
                          std::vector<uint8_t>& bytes, EncodeStats& stats) {
  const reeb::tools::EncodingReport aim = reeb::tools::aim_of(options);
  if (report) reeb::tools::reserve_report(aim, sequence.metadata);
  double vertex_frames = 0;
  for (const reeb::Shot& s : sequence.shots)
    vertex_frames += static_cast<double>(s.connectivity.vertex_count) * s.frame_count;
  Status status = reeb::encode(sequence, options, bytes, stats);
  if (status.ok() && report) status = reeb::tools::keep_report(aim, vertex_frames, bytes, stats);
  return status;
}

void add_time(const nb::dict& about, reeb::Sequence& out) {
  out.frame_rate = nb::cast<double>(about["fps"]);
  out.start_time = nb::cast<double>(about["start_time"]);
  out.metadata = nb::cast<std::map<std::string, std::string>>(about["metadata"]);
  out.metadata.erase(reeb::tools::kReportKey);
}

/// `about`: fps, start_time, metadata, attributes (dicts), resources (name, media type, bytes).
reeb::Sequence sequence_of(const Frames& positions, const Indices& sizes, const Indices& corners,
                           const nb::dict& about, bool lossless) {
  reeb::Sequence out;
  reeb::Shot& shot = out.shots.emplace_back();
  shot.connectivity = connectivity_of(positions.shape(1), sizes, corners);
  shot.frame_count = static_cast<uint32_t>(positions.shape(0));
  shot.positions.assign(positions.data(), positions.data() + positions.size());
  add_time(about, out);
  for (const nb::handle a : nb::cast<nb::list>(about["attributes"]))
    shot.attributes.push_back(attribute_of(nb::cast<nb::dict>(a), lossless));
  for (const nb::handle item : nb::cast<nb::list>(about["resources"])) {
    const auto r = nb::cast<nb::tuple>(item);
    const auto bytes = nb::cast<nb::bytes>(r[2]);
    const auto* const first = reinterpret_cast<const uint8_t*>(bytes.c_str());
    out.resources.push_back(
        {nb::cast<std::string>(r[0]), nb::cast<std::string>(r[1]), {first, first + bytes.size()}});
  }
  return out;
}

/// The bytes of the file and its figures.
nb::tuple encode(const Frames& positions, const Indices& sizes, const Indices& corners,
                 const nb::dict& about, const nb::dict& choices, const nb::object& progress) {
  EncodeOptions options = options_of(choices);
  const bool report = options.bounds;
  reeb::Sequence sequence =
      sequence_of(positions, sizes, corners, about, options.target == Target::kLossless);
  JobState state;
  options.progress = [&state](double done) {
    state.done = done;
    return state.stop == 0;
  };
  options.stop = reeb::StopToken(state.stop);
  std::vector<uint8_t> bytes;
  EncodeStats stats;
  double told = -1;
  const auto tell = [&] {
    if (progress.is_none() || state.done == told) return;
    told = state.done;
    progress(told);
  };
  check(run_job([&] { return encode_with_report(sequence, options, report, bytes, stats); },
                [&] { ++state.stop; }, tell));
  if (!progress.is_none()) progress(1.0);
  return nb::make_tuple(nb::bytes(bytes.data(), bytes.size()), figures(stats));
}

/// What a file says of its encoding: figures as of `encode`, with target and wanted; an error that
/// it does not tell is None.
nb::dict report(const nb::bytes& data) {
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(data.c_str()), data.size());
  reeb::ContainerReader file;
  check(file.parse(bytes, reeb::Limits{}));
  double vertex_frames = 0;
  for (const reeb::GroupChunk& g : file.groups) {
    if (const reeb::ReferenceChunk* r = file.reference(g.header.shot))
      vertex_frames += static_cast<double>(r->mesh_header.vertex_count) * g.header.frame_count;
  }
  reeb::tools::EncodingReport told;
  bool known = false;
  for (const reeb::MetadataEntry& m : file.metadata)
    known = known || (m.key == reeb::tools::kReportKey && reeb::tools::parse_report(m.value, told));
  EncodeStats stats;
  stats.bytes = data.size();
  stats.bpvf = vertex_frames > 0 ? 8 * static_cast<double>(data.size()) / vertex_frames : 0;
  stats.kg = told.kg;
  stats.rmse = told.rmse;
  stats.max_error = told.max_error;
  for (const auto& [name, size] : file.sections)
    stats.sections.push_back({name, 8 * static_cast<double>(size)});
  nb::dict out = figures(stats);
  out["target"] = known ? nb::cast(told.target) : nb::none();
  out["wanted"] = nb::cast(told.wanted);
  if (!known) {
    for (const char* name : {"kg", "rmse", "max_error"}) out[name] = nb::none();
  }
  return out;
}

/// A lossless file that grows as frames come.
class LosslessWriter {
 public:
  LosslessWriter(const std::string& path, size_t vertices, const Indices& sizes,
                 const Indices& corners, const nb::dict& about, int effort, uint32_t group_length,
                 unsigned threads)
      : file_(std::filesystem::u8path(path), std::ios::binary),
        encoder_(
            {.group_length = group_length,
             .method = {.quick = effort <= reeb::kQuickEffort, .stop = reeb::StopToken(requests_)},
             .threads = threads},
            [this](std::span<const uint8_t> part) {
              file_.write(reinterpret_cast<const char*>(part.data()),
                          static_cast<std::streamsize>(part.size()));
              return static_cast<bool>(file_);
            }) {
    constexpr uint32_t kFrames = 1 << 20;  // at most: the limit that decoders have
    reeb::Sequence sequence;
    add_time(about, sequence);
    std::vector<reeb::MetadataEntry> metadata;
    for (const auto& [key, value] : sequence.metadata) metadata.push_back({key, value});
    check(encoder_.begin({.total_frames = kFrames,
                          .frame_rate = sequence.frame_rate,
                          .start_time = sequence.start_time,
                          .flags = reeb::SequenceHeader::kOpenEnded},
                         metadata));
    check(encoder_.begin_shot(connectivity_of(vertices, sizes, corners)));
  }

  void add(const nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>& frame) {
    check(run_job(
        [&] {
          return encoder_.add_frame({frame.data(), frame.size()});
        },
        [&] { ++requests_; }, [] {}));
  }
  void finish() {
    check(run_job([&] { return encoder_.finish(); }, [&] { ++requests_; }, [] {}));
    file_.close();
    if (!file_) throw Failure{REEB_IO, "the output cannot be written"};
  }
  uint64_t bytes() const { return encoder_.bytes(); }

 private:
  std::ofstream file_;
  std::atomic<uint32_t> requests_{0};  // to stop
  reeb::StreamEncoder encoder_;
};

}  // namespace

void add_writing(nb::module_& module) {
  module.def("encode", encode, "positions"_a, "sizes"_a, "corners"_a, "about"_a, "choices"_a,
             "progress"_a.none());
  module.def("report", report, "data"_a);
  nb::class_<LosslessWriter>(module, "LosslessWriter")
      .def(nb::init<const std::string&, size_t, const Indices&, const Indices&, const nb::dict&,
                    int, uint32_t, unsigned>(),
           "path"_a, "vertices"_a, "sizes"_a, "corners"_a, "about"_a, "effort"_a, "group_length"_a,
           "threads"_a)
      .def("add", &LosslessWriter::add, "frame"_a)
      .def("finish", &LosslessWriter::finish)
      .def_prop_ro("bytes", &LosslessWriter::bytes);
}

}  // namespace reeb_python
