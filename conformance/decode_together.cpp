// decode_together STREAM...: decodes each stream on several threads at a time, by decoders of their
// own and by one that they share, forwards and backwards, the next group ahead. Fails where a frame
// differs from what one thread gives. For ThreadSanitizer, see tests/threads.sh.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <thread>
#include <vector>

#include "codec/dec/decoder.h"

namespace {

using Frames = std::vector<std::vector<float>>;

std::unique_ptr<reeb::Decoder> open(const std::vector<uint8_t>& bytes, unsigned threads) {
  reeb::DecodeOptions options;
  options.threads = threads;
  options.prefetch = threads > 1;
  options.cache_bytes = 1;  // groups are decoded again and again
  std::unique_ptr<reeb::Decoder> decoder;
  (void)reeb::Decoder::open(bytes, options, decoder);
  return decoder;
}

std::vector<float> decode(reeb::Decoder& decoder, uint32_t frame) {
  const reeb::Connectivity* mesh = nullptr;
  if (!decoder.connectivity(frame, mesh).ok()) return {};
  std::vector<float> xyz(size_t{mesh->vertex_count} * 3);
  if (!decoder.decode_frame(frame, xyz.data()).ok()) xyz.clear();
  return xyz;
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

void play(reeb::Decoder& decoder, const Frames& expected, bool backwards, int& wrong) {
  const auto count = static_cast<uint32_t>(expected.size());
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t frame = backwards ? count - 1 - i : i;
    wrong += !same(decode(decoder, frame), expected[frame]);
  }
}

/// Frames that were not what they should be, and streams that do not open.
int check(const std::vector<uint8_t>& bytes) {
  constexpr size_t kPlayers = 4;
  const std::unique_ptr<reeb::Decoder> alone = open(bytes, 1), shared = open(bytes, 2);
  if (!alone || !shared) return 1;
  Frames expected(alone->info().frame_count);
  for (uint32_t t = 0; t < expected.size(); ++t) expected[t] = decode(*alone, t);
  int wrong[kPlayers] = {};
  std::vector<std::thread> threads;
  for (size_t i = 0; i < kPlayers; ++i) {
    threads.emplace_back([&, i] {
      const bool backwards = i % 2 != 0;
      if (i < 2) return play(*shared, expected, backwards, wrong[i]);
      const std::unique_ptr<reeb::Decoder> own = open(bytes, 2);
      own ? play(*own, expected, backwards, wrong[i]) : void(++wrong[i]);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return wrong[0] + wrong[1] + wrong[2] + wrong[3];
}

}  // namespace

int main(int argc, char** argv) {
  int failed = 0;
  for (int i = 1; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(in)), {});
    if (check({bytes.begin(), bytes.end()}) == 0) continue;
    std::fprintf(stderr, "decode_together: %s: frames differ\n", argv[i]);
    ++failed;
  }
  std::printf("%d streams, %d failed\n", argc - 1, failed);
  return failed > 0 ? 1 : 0;
}
