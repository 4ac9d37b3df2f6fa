#include "codec/enc/search/lossless_offer.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "codec/enc/lossless/lossless_sequence.h"
#include "codec/enc/search/sequence_summary.h"

namespace reeb {

namespace {

constexpr double kMinBits = 0.1;  ///< that a coordinate which moves takes, foreseen ever so well
constexpr uint32_t kSampleFrames = 16;  ///< of each shot
constexpr uint32_t kSampleFront = 4;    ///< of them: what they take says nothing of later frames
constexpr double kDoubt = 1.2;          ///< by which the frames left out may take less

bool same_frame(std::span<const float> a, std::span<const float> b) {
  return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

/// Coordinates that are not, to the bit, where they were in the frame before.
double moving_coordinates(const Sequence& sequence) {
  double count = 0;
  for (const Shot& shot : sequence.shots) {
    for (uint32_t t = 1; t < shot.frame_count; ++t) {
      const auto before = shot.frame(t - 1), now = shot.frame(t);
      if (same_frame(before, now)) continue;
      for (size_t i = 0; i < now.size(); ++i) count += now[i] != before[i] ? 1 : 0;
    }
  }
  return count;
}

/// Frames from the middle of a shot, `count` of them at most.
Shot middle_of(const Shot& shot, uint32_t count) {
  Shot out;
  out.connectivity = shot.connectivity;
  out.frame_count = std::min(count, shot.frame_count);
  const size_t first = (shot.frame_count - out.frame_count) / 2;
  const size_t size = shot.frame(0).size();
  const auto begin = shot.positions.begin() + static_cast<ptrdiff_t>(first * size);
  out.positions.assign(begin, begin + static_cast<ptrdiff_t>(out.frame_count * size));
  return out;
}

uint32_t distinct_frames(const Shot& shot) {
  uint32_t count = 1;
  for (uint32_t t = 1; t < shot.frame_count; ++t)
    count += same_frame(shot.frame(t - 1), shot.frame(t)) ? 0 : 1;
  return count;
}

/// Adds the bytes that the shot takes, from those of a few frames, or, where even these are more
/// than `most` with those before, theirs.
Status expect_shot(const Shot& shot, const EncodeOptions& options, double most, double& bytes) {
  const auto size_of = [&](uint32_t frames, double& size) {
    Sequence sample;
    sample.shots.push_back(middle_of(shot, frames));
    std::vector<uint8_t> coded;
    EncodeStats unused;
    Status status = encode_exactly(sample, options, coded, unused);
    size = static_cast<double>(coded.size());
    return status;
  };
  double front = 0, all = 0;
  if (Status s = size_of(kSampleFront, front); !s.ok()) return s;
  if (bytes + front > most) {
    bytes += front;
    return {};
  }
  if (Status s = size_of(kSampleFrames, all); !s.ok()) return s;
  const double frames = std::min(shot.frame_count, kSampleFrames);
  const double more = std::max(0.0, distinct_frames(shot) - frames);
  bytes += all + more * (all - front) / (kSampleFrames - kSampleFront);
  return {};
}

}  // namespace

Status encode_exactly(const Sequence& sequence, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats) {
  return encode_lossless(sequence, options, {.face_order = false}, out, stats);
}

Status offer_lossless(const Sequence& sequence, const EncodeOptions& options,
                      std::vector<uint8_t>& out, EncodeStats& stats) {
  double most = static_cast<double>(out.size());
  if (options.target == Target::kSize) most = options.target_value;
  if (options.target == Target::kBpvf) most = options.target_value * vertex_frames_of(sequence) / 8;
  if (kMinBits * moving_coordinates(sequence) > 8 * most) return {};
  EncodeOptions sampling = options;
  sampling.progress = nullptr;
  double expected = 0;
  for (const Shot& shot : sequence.shots) {
    if (Status s = expect_shot(shot, sampling, kDoubt * most, expected); !s.ok()) return s;
    if (expected > kDoubt * most) return {};
  }
  std::vector<uint8_t> exact;
  EncodeStats exact_stats;
  if (Status s = encode_exactly(sequence, sampling, exact, exact_stats); !s.ok()) return s;
  if (static_cast<double>(exact.size()) > most) return {};
  out = std::move(exact);
  stats = std::move(exact_stats);
  stats.notes.push_back("lossless coding, since that is no larger");
  return {};
}

}  // namespace reeb
