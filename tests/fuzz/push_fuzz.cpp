// A stream pushed in pieces that the input chooses: what is there at the end is what a decoder that
// has the whole file finds, and no piece asks for more than the limits allow. Input: a byte that
// chooses the pieces, then the file, whose checksums are repaired.
#include <algorithm>
#include <cstring>
#include <vector>

#include "codec/dec/decoder.h"
#include "tests/codec/damage.h"

namespace {

constexpr uint32_t kMaxFrames = 4;

reeb::DecodeOptions options() {
  reeb::DecodeOptions out;
  out.limits = {
      .max_vertices = 1024, .max_faces = 2048, .max_frames = 4096, .max_memory = 64u << 20};
  return out;
}

/// Bits of the first frames; empty where one does not decode.
std::vector<std::vector<float>> frames_of(reeb::Decoder& decoder) {
  std::vector<std::vector<float>> out(std::min(decoder.info().frame_count, kMaxFrames));
  for (uint32_t frame = 0; frame < out.size(); ++frame) {
    const reeb::Connectivity* connectivity = nullptr;
    if (!decoder.connectivity(frame, connectivity).ok()) continue;
    out[frame].resize(size_t{connectivity->vertex_count} * 3);
    if (!decoder.decode_frame(frame, out[frame].data()).ok()) out[frame].clear();
  }
  return out;
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

bool push_all(reeb::Decoder& decoder, std::span<const uint8_t> file, uint8_t choice) {
  uint32_t state = choice;
  while (!file.empty()) {
    state = state * 1664525 + 1013904223;
    const size_t piece = std::min<size_t>(file.size(), 1 + (state >> 16) % (1 + 8 * (choice % 64)));
    if (!decoder.push(file.first(piece)).ok()) return false;
    file = file.subspan(piece);
  }
  return decoder.finish().ok();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  std::vector<uint8_t> file(data + 1, data + size);
  reeb::test::repair_checksums(file);
  std::unique_ptr<reeb::Decoder> whole, pushed;
  if (!reeb::Decoder::open_pushed(options(), pushed).ok()) __builtin_trap();
  const bool pushed_ok = push_all(*pushed, file, data[0]);
  const bool whole_ok = reeb::Decoder::open(file, options(), whole).ok();
  // A file that is refused as a whole may look sound as far as it has come, not the other way
  // round.
  if (pushed_ok && !whole_ok) __builtin_trap();
  if (!pushed_ok || !whole_ok) {
    frames_of(*pushed);
    return 0;
  }
  const auto a = frames_of(*whole), b = frames_of(*pushed);
  if (!std::equal(a.begin(), a.end(), b.begin(), b.end(), same)) __builtin_trap();
  return 0;
}
