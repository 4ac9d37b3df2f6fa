#include "codec/enc/lossless_sequence.h"

#include "bitstream/container.h"
#include "codec/enc/stream_encoder.h"

namespace reeb {

namespace {

constexpr int kQuickEffort = 3;  ///< up to this effort the quick method is used

std::vector<MetadataEntry> metadata_of(const Sequence& sequence) {
  std::vector<MetadataEntry> out;
  for (const auto& [key, value] : sequence.metadata) out.push_back({key, value});
  return out;
}

Status push_frames(const Sequence& sequence, const EncodeOptions& options, StreamEncoder& encoder) {
  uint32_t done = 0;
  for (const Shot& shot : sequence.shots) {
    if (Status s = encoder.begin_shot(shot.connectivity); !s.ok()) return s;
    for (uint32_t t = 0; t < shot.frame_count; ++t) {
      if (Status s = encoder.add_frame(shot.frame(t)); !s.ok()) return s;
      if (options.progress &&
          !options.progress(++done / static_cast<double>(sequence.frame_count())))
        return {StatusCode::kCancelled, "encoding was cancelled"};
    }
  }
  return encoder.finish();
}

EncodeStats stats_of(const Sequence& sequence, const std::vector<uint8_t>& bytes) {
  EncodeStats out;
  double vertex_frames = 0;
  for (const Shot& shot : sequence.shots)
    vertex_frames += static_cast<double>(shot.connectivity.vertex_count) * shot.frame_count;
  out.bytes = bytes.size();
  out.bpvf = 8 * static_cast<double>(out.bytes) / vertex_frames;
  ContainerReader container;
  if (container.parse(bytes, Limits{}).ok()) {
    for (const auto& [name, size] : container.sections)
      out.sections.push_back({name, 8.0 * static_cast<double>(size)});
  }
  return out;
}

}  // namespace

Status encode_lossless(const Sequence& sequence, const EncodeOptions& options, double step,
                       std::vector<uint8_t>& out, EncodeStats& stats) {
  std::vector<uint8_t> bytes;
  StreamEncoder encoder({.group_length = options.group_length,
                         .reorder = options.reorder,
                         .face_order = step == 0,
                         .method = {options.effort <= kQuickEffort, step},
                         .threads = options.threads},
                        [&](std::span<const uint8_t> part) {
                          bytes.insert(bytes.end(), part.begin(), part.end());
                          return true;
                        });
  SequenceHeader header;
  header.total_frames = sequence.frame_count();
  header.shot_count = static_cast<uint32_t>(sequence.shots.size());
  header.frame_rate = sequence.frame_rate;
  header.start_time = sequence.start_time;
  if (Status s = encoder.begin(header, metadata_of(sequence)); !s.ok()) return s;
  if (Status s = push_frames(sequence, options, encoder); !s.ok()) return s;
  stats = stats_of(sequence, bytes);
  out = std::move(bytes);
  return {};
}

}  // namespace reeb
