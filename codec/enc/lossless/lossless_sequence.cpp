#include "codec/enc/lossless/lossless_sequence.h"

#include "codec/enc/lossless/stream_encoder.h"
#include "codec/enc/search/sequence_summary.h"

namespace reeb {

namespace {

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

}  // namespace

Status encode_lossless(const Sequence& sequence, const EncodeOptions& options,
                       const LosslessOptions& lossless, std::vector<uint8_t>& out,
                       EncodeStats& stats) {
  std::vector<uint8_t> bytes;
  StreamEncoder encoder({.group_length = options.group_length,
                         .reorder = options.reorder,
                         .face_order = lossless.face_order,
                         .method = {options.effort <= kQuickEffort, lossless.step, options.stop},
                         .threads = options.threads},
                        [&](std::span<const uint8_t> part) {
                          bytes.insert(bytes.end(), part.begin(), part.end());
                          return true;
                        });
  if (Status s = encoder.begin(header_of(sequence), metadata_of(sequence)); !s.ok()) return s;
  if (Status s = push_frames(sequence, options, encoder); !s.ok()) return s;
  stats = size_stats(bytes, vertex_frames_of(sequence));
  out = std::move(bytes);
  return {};
}

}  // namespace reeb
