// A whole stream, its checksums repaired so that damage reaches the payloads: every frame there is
// decodes or is refused, within the limits, and the same a second time.
#include <algorithm>
#include <cstring>
#include <vector>

#include "codec/dec/decoder.h"
#include "tests/codec/damage.h"

namespace {

constexpr uint32_t kMaxFrames = 8;

std::vector<float> decode(std::span<const uint8_t> bytes, bool backwards) {
  reeb::DecodeOptions options;
  options.limits = {
      .max_vertices = 1024, .max_faces = 2048, .max_frames = 4096, .max_memory = 64u << 20};
  std::unique_ptr<reeb::Decoder> decoder;
  if (!reeb::Decoder::open(bytes, options, decoder).ok()) return {};
  const uint32_t count = std::min(decoder->info().frame_count, kMaxFrames);
  std::vector<std::vector<float>> frames(count);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t frame = backwards ? count - 1 - i : i;
    const reeb::Connectivity* connectivity = nullptr;
    if (!decoder->connectivity(frame, connectivity).ok()) continue;
    for (const uint32_t corner : connectivity->corners) {
      if (corner >= connectivity->vertex_count) __builtin_trap();
    }
    frames[frame].resize(size_t{connectivity->vertex_count} * 3);
    if (!decoder->decode_frame(frame, frames[frame].data()).ok()) frames[frame].clear();
  }
  std::vector<float> out;
  for (const auto& f : frames) out.insert(out.end(), f.begin(), f.end());
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::vector<uint8_t> file(data, data + size);
  reeb::test::repair_checksums(file);
  const std::vector<float> forwards = decode(file, false);
  const std::vector<float> backwards = decode(file, true);
  const size_t bytes = forwards.size() * sizeof(float);
  const bool same = forwards.size() == backwards.size() &&
                    (bytes == 0 || std::memcmp(forwards.data(), backwards.data(), bytes) == 0);
  if (!same) __builtin_trap();
  return 0;
}
