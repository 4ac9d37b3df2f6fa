#include <algorithm>
#include <atomic>

#include "codec/common/base/parallel.h"
#include "codec/dec/attributes/attribute_decoder.h"
#include "codec/dec/attributes/attribute_store.h"
#include "codec/dec/decoder.h"
#include "codec/dec/group_memory.h"
#include "codec/dec/group_store.h"
#include "codec/dec/guard.h"

namespace reeb {

namespace {

/// Decodes the groups of one shot after another, several groups at a time.
class SequenceDecoder {
 public:
  SequenceDecoder(std::span<const uint8_t> bytes, const DecodeOptions& options)
      : bytes_(bytes),
        options_(options),
        source_(bytes),
        account_(options.limits.max_memory),
        store_(source_, options, account_),
        attributes_(source_, account_, store_) {}

  Status run(Sequence& out);
  /// Frames that `run` did not give.
  std::vector<StreamInfo::Gap> missing() const;

 private:
  /// Consecutive groups: of one shot, or each continuing the one before.
  struct Run {
    size_t begin = 0, end = 0;
  };
  /// A place for the positions of the groups of a run, and what came of each.
  struct Output {
    Run run;
    std::vector<size_t> first;  ///< float of each group's first frame, and of the end
    std::vector<Status> results;
    float* positions;
  };

  Status add_shot(const ReferenceChunk& reference, const Run& run, Shot& shot);
  Status add_attributes(const ReferenceChunk& reference, const Run& run, Shot& shot);
  Status add_frames(const std::shared_ptr<const KeptAttribute>& kept, const Run& run,
                    const Shot& shot, Attribute& attribute);
  Status add_resources(Sequence& out);
  Status decode_groups(const ReferenceChunk& reference, const Run& run, Shot& shot);
  std::vector<Run> split(const Run& run) const;
  void decode_run(const ReferenceChunk& reference, const Run& run, unsigned threads, Output& out);
  Status collect(const Output& out, Shot& shot);
  unsigned workers(uint64_t vertices, const Run& run, size_t parts) const;
  Status add_metadata(Sequence& out);
  Status check_complete();
  Status check_attributes() const;

  std::span<const uint8_t> bytes_;
  const DecodeOptions& options_;
  MemorySource source_;
  MemoryAccount account_;
  Lease output_;
  ContainerReader container_;
  GroupStore store_;
  AttributeStore attributes_;
  Status damage_;              // the first group that did not decode
  std::vector<bool> decoded_;  // groups
};

// Into runs that decode on their own.
std::vector<SequenceDecoder::Run> SequenceDecoder::split(const Run& run) const {
  std::vector<Run> out;
  for (size_t g = run.begin; g < run.end; ++g) {
    if (out.empty() || !container_.groups[g].continues()) out.push_back({g, g});
    out.back().end = g + 1;
  }
  return out;
}

// What follows a group that does not decode, or that is missing, is lost with it.
void SequenceDecoder::decode_run(const ReferenceChunk& reference, const Run& run, unsigned threads,
                                 Output& out) {
  HeldState state;
  Status status;
  for (size_t g = run.begin; g < run.end; ++g) {
    const GroupChunk& chunk = container_.groups[g];
    const size_t i = g - out.run.begin;
    const bool whole =
        g == run.begin ? !chunk.continues() : follows(chunk, container_.groups[g - 1]);
    if (status.ok() && (!whole || g - run.begin > kMaxOpenGroups))
      status = Status::corrupt("a group continues one that is not there");
    std::shared_ptr<const OpenGroup> group;
    if (status.ok())
      status = store_.decode_next(chunk, reference, threads, g + 1 < run.end, state, group);
    out.results[i] = status;
    if (!status.ok()) continue;
    const size_t frame_size = group->shot->surface.output.size() * 3;
    group->synthesis.frames(0, chunk.header.frame_count, out.positions + out.first[i], frame_size,
                            3);
  }
}

// As many as there are threads for, runs to decode, and memory to do it in.
unsigned SequenceDecoder::workers(uint64_t vertices, const Run& run, size_t parts) const {
  uint64_t most = 1;
  for (size_t g = run.begin; g < run.end; ++g) {
    const GroupChunk& group = container_.groups[g];
    most = std::max(
        most, group_memory(vertices, group.header, true) + state_memory(vertices) + group.size);
  }
  const uint64_t fit = (account_.limit() - account_.used()) / most;
  const uint64_t wanted = std::min<uint64_t>(resolve_threads(options_.threads), parts);
  return static_cast<unsigned>(std::max<uint64_t>(1, std::min(fit, wanted)));
}

// Closes the gaps that groups leave which do not decode.
Status SequenceDecoder::collect(const Output& out, Shot& shot) {
  size_t end = 0;
  for (size_t i = 0; i < out.results.size(); ++i) {
    const Status& result = out.results[i];
    if (!result.ok() && result.code() != StatusCode::kCorrupt) return result;
    if (!result.ok() && damage_.ok()) damage_ = result;
    if (!result.ok()) continue;
    decoded_[out.run.begin + i] = true;
    const size_t size = out.first[i + 1] - out.first[i];
    if (end != out.first[i]) std::copy_n(out.positions + out.first[i], size, out.positions + end);
    end += size;
    shot.frame_count += container_.groups[out.run.begin + i].header.frame_count;
  }
  shot.positions.resize(end);
  return {};
}

Status SequenceDecoder::decode_groups(const ReferenceChunk& reference, const Run& run, Shot& shot) {
  const size_t frame_size = size_t{shot.connectivity.vertex_count} * 3;
  Output out = {run, {0}, std::vector<Status>(run.end - run.begin), shot.positions.data()};
  for (size_t g = run.begin; g < run.end; ++g)
    out.first.push_back(out.first.back() + container_.groups[g].header.frame_count * frame_size);
  const std::vector<Run> parts = split(run);
  const unsigned count = workers(shot.connectivity.vertex_count, run, parts.size());
  const unsigned threads = std::max(1u, resolve_threads(options_.threads) / count);
  std::atomic<size_t> next{0};
  parallel_ranges(count, count, [&](uint32_t, uint32_t) {
    for (size_t i = next++; i < parts.size(); i = next++)
      decode_run(reference, parts[i], threads, out);
  });
  return collect(out, shot);
}

Status SequenceDecoder::add_shot(const ReferenceChunk& reference, const Run& run, Shot& shot) {
  std::shared_ptr<ShotFaces> faces;
  if (Status s = store_.get_faces(reference, {}, faces); !s.ok()) return s;
  uint64_t frames = 0;
  for (size_t g = run.begin; g < run.end; ++g) frames += container_.groups[g].header.frame_count;
  const uint64_t floats = 3 * uint64_t{faces->connectivity.vertex_count} * frames;
  if (floats > options_.limits.max_memory / sizeof(float) ||
      !output_.grow(account_, floats * sizeof(float) + kept_memory(faces->connectivity)))
    return Status::limit("the sequence needs more memory than the limit allows");
  shot.connectivity = faces->connectivity;
  shot.positions.resize(static_cast<size_t>(floats));
  return decode_groups(reference, run, shot);
}

// In the frames that have positions.
Status SequenceDecoder::add_frames(const std::shared_ptr<const KeptAttribute>& kept, const Run& run,
                                   const Shot& shot, Attribute& attribute) {
  if (!attribute.animated) return {};
  uint32_t frame = 0;
  for (size_t g = run.begin; g < run.end; ++g) {
    if (!decoded_[g]) continue;
    const GroupHeader& group = container_.groups[g].header;
    const AttributeGroupChunk* part =
        container_.attribute_group(group.first_frame, kept->header.index);
    if (part == nullptr && kept->header.in_groups())
      return Status::corrupt("attribute \"" + attribute.name + "\" is missing in frame " +
                             std::to_string(uint64_t{group.first_frame} + 1));
    for (uint32_t t = 0; t < group.frame_count; ++t, ++frame) {
      SiteNumbers coded, normals;
      Status s;
      if (kept->header.in_groups())
        s = attributes_.get_frame(kept, *part, t, resolve_threads(options_.threads), {}, coded);
      if (s.ok() && kept->header.computed())
        s = attributes_.get_normals(kept, shot.frame(frame), coded, normals);
      if (!s.ok()) return s;
      append_numbers(kept->header.computed() ? normals : coded, attribute.values);
    }
  }
  return {};
}

// One that does not decode is left out.
Status SequenceDecoder::add_attributes(const ReferenceChunk& reference, const Run& run,
                                       Shot& shot) {
  for (const AttributeChunk& chunk : container_.attributes) {
    if (chunk.header.shot != reference.header.shot) continue;
    std::shared_ptr<const KeptAttribute> kept;
    Status status = attributes_.get(chunk, reference, kept);
    if (status.code() == StatusCode::kCorrupt && damage_.ok()) damage_ = status;
    if (!status.ok() && status.code() != StatusCode::kCorrupt) return status;
    if (!status.ok()) continue;
    const uint64_t frames = kept->attribute.animated ? shot.frame_count : 1;
    if (!output_.grow(account_, frames * attribute_bytes(kept->header, shot.connectivity)))
      return Status::limit("the sequence needs more memory than the limit allows");
    Attribute attribute = kept->attribute;
    if (Status s = add_frames(kept, run, shot, attribute); s.code() == StatusCode::kCorrupt) {
      if (damage_.ok()) damage_ = s;
    } else if (!s.ok()) {
      return s;
    } else {
      shot.attributes.push_back(std::move(attribute));
    }
  }
  return {};
}

Status SequenceDecoder::add_resources(Sequence& out) {
  for (const ResourceChunk& chunk : container_.resources) {
    if (!output_.grow(account_, chunk.size))
      return Status::limit("the resources need more memory than the limit allows");
    if (Status s = attributes_.get_resource(chunk, out.resources.emplace_back()); !s.ok()) return s;
  }
  return {};
}

// Frames do not miss what these chunks hold, but the caller does.
Status SequenceDecoder::check_attributes() const {
  for (const DamagedRange& range : container_.damaged) {
    if (range.type == to_string(kAttributeChunk) || range.type == to_string(kResourceChunk) ||
        range.type == to_string(kAttributeGroupChunk)) {
      return Status::corrupt("chunk " + range.type + " at byte " + std::to_string(range.offset) +
                             " is damaged");
    }
  }
  return {};
}

Status SequenceDecoder::add_metadata(Sequence& out) {
  constexpr uint64_t kEntryBytes = 2 * sizeof(std::string) + 64;  // of a map
  for (const MetadataEntry& m : container_.metadata) {
    if (!output_.grow(account_, kEntryBytes + text_memory(m.key) + text_memory(m.value)))
      return Status::limit("the metadata need more memory than the limit allows");
    out.metadata[m.key] = m.value;
  }
  return {};
}

Status SequenceDecoder::check_complete() {
  if (!damage_.ok()) return damage_;
  StreamInfo info;
  Lease lease;
  if (!lease.grow(account_, info_memory(container_)))
    return Status::limit("the headers need more memory than allowed");
  update_info(container_, bytes_.size(), true, 0, info);
  if (info.missing.empty()) return check_attributes();
  const StreamInfo::Gap& gap = info.missing.front();
  const std::string from = "frame " + std::to_string(gap.first_frame + 1);
  if (container_.truncated && gap.first_frame == info.frame_count)
    return Status::truncated("the stream ends before " + from);
  return Status::corrupt(from + " to " +
                         std::to_string(uint64_t{gap.first_frame} + gap.frame_count) +
                         " are damaged or cut off");
}

Status SequenceDecoder::run(Sequence& out) {
  if (Status s = container_.parse(bytes_, options_.limits, account_); !s.ok()) return s;
  out.frame_rate = container_.header.frame_rate;
  out.start_time = container_.header.start_time;
  if (Status s = add_metadata(out); !s.ok()) return s;
  const auto& groups = container_.groups;
  decoded_.assign(groups.size(), false);
  for (Run run; run.begin < groups.size(); run.begin = run.end) {
    const uint32_t shot = groups[run.begin].header.shot;
    while (run.end < groups.size() && groups[run.end].header.shot == shot) ++run.end;
    const ReferenceChunk* reference = container_.reference(shot);
    if (reference == nullptr) continue;
    out.shots.emplace_back();
    Status status = add_shot(*reference, run, out.shots.back());
    if (status.code() == StatusCode::kCorrupt && damage_.ok()) damage_ = status;
    if (!status.ok() && status.code() != StatusCode::kCorrupt) return status;
    if (out.shots.back().frame_count == 0) {
      out.shots.pop_back();
    } else if (Status s = add_attributes(*reference, run, out.shots.back()); !s.ok()) {
      return s;
    }
  }
  if (Status s = add_resources(out); !s.ok()) return s;
  return check_complete();
}

std::vector<StreamInfo::Gap> SequenceDecoder::missing() const {
  std::vector<StreamInfo::Gap> gaps;
  uint32_t next = 0;
  const auto close_gap = [&](uint32_t end) {
    if (next < end) gaps.push_back({next, end - next});
  };
  for (size_t g = 0; g < decoded_.size(); ++g) {
    if (!decoded_[g]) continue;
    const GroupHeader& h = container_.groups[g].header;
    close_gap(h.first_frame);
    next = h.first_frame + h.frame_count;
  }
  close_gap(container_.header.total_frames);
  return gaps;
}

}  // namespace

Status decode_sequence(std::span<const uint8_t> bytes, const DecodeOptions& options, Sequence& out,
                       std::vector<StreamInfo::Gap>* missing) {
  out = {};
  Status status = guarded([&] {
    SequenceDecoder decoder(bytes, options);
    Status result = decoder.run(out);
    if (missing != nullptr) *missing = decoder.missing();
    return result;
  });
  const bool partly =
      status.code() == StatusCode::kTruncated || status.code() == StatusCode::kCorrupt;
  if (!status.ok() && !partly) out = {};
  return status;
}

}  // namespace reeb
