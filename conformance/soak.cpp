// soak SECONDS STREAM...: plays streams on several threads for a while, as hosts at their worst do:
// opens and closes while the next group is decoded ahead, reads slowly, pushes in pieces, cancels
// at any moment, allows too little memory. Fails where a frame that is given differs from what one
// thread alone gives, where a call fails for no reason, or where memory is lost. See
// tests/threads.sh and tests/soak.sh.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "codec/dec/decoder.h"
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using Clock = std::chrono::steady_clock;

struct Stream {
  std::vector<uint8_t> bytes;
  std::vector<std::vector<float>> frames;
  uint64_t memory = 0;  ///< that playing it takes
};

/// Bytes that come late.
class SlowSource : public reeb::ByteSource {
 public:
  explicit SlowSource(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  uint64_t size() const override { return bytes_.size(); }
  reeb::Status read(uint64_t offset, size_t count, std::vector<uint8_t>& buffer,
                    std::span<const uint8_t>& out) override {
    std::this_thread::sleep_for(std::chrono::microseconds(count % 700));
    const auto from = bytes_.begin() + static_cast<ptrdiff_t>(offset);
    buffer.assign(from, from + static_cast<ptrdiff_t>(count));
    out = buffer;
    return {};
  }

 private:
  std::span<const uint8_t> bytes_;
};

reeb::Status decode(reeb::Decoder& decoder, uint32_t frame, std::vector<float>& xyz) {
  const reeb::Connectivity* mesh = nullptr;
  if (reeb::Status s = decoder.connectivity(frame, mesh); !s.ok()) return s;
  xyz.resize(size_t{mesh->vertex_count} * 3);
  return decoder.decode_frame(frame, xyz.data());
}

bool load(const char* path, Stream& out) {
  std::ifstream in(path, std::ios::binary);
  out.bytes.assign(std::istreambuf_iterator<char>(in), {});
  std::unique_ptr<reeb::Decoder> decoder;
  if (!reeb::Decoder::open(out.bytes, {}, decoder).ok()) return false;
  out.frames.resize(decoder->info().frame_count);
  for (uint32_t t = 0; t < out.frames.size(); ++t) {
    if (!decode(*decoder, t, out.frames[t]).ok()) return false;
  }
  out.memory = decoder->stats().peak_memory;
  return !out.frames.empty();
}

/// One host after another.
class Host {
 public:
  Host(const std::vector<Stream>& streams, unsigned seed) : streams_(streams), random_(seed) {}

  void run(Clock::time_point end) {
    while (Clock::now() < end) play(streams_[below(streams_.size())]);
  }
  uint64_t frames() const { return frames_; }
  uint64_t faults() const { return faults_; }

 private:
  size_t below(size_t count) { return random_() % count; }

  reeb::Status open(const Stream& stream, const reeb::DecodeOptions& options,
                    std::unique_ptr<reeb::Decoder>& decoder) {
    switch (below(3)) {
      case 0:
        return reeb::Decoder::open(stream.bytes, options, decoder);
      case 1:
        return reeb::Decoder::open(std::make_unique<SlowSource>(stream.bytes), options, decoder);
      default:
        break;
    }
    if (reeb::Status s = reeb::Decoder::open_pushed(options, decoder); !s.ok()) return s;
    const size_t piece = 1 + below(stream.bytes.size());
    for (size_t at = 0; at < stream.bytes.size(); at += piece) {
      const size_t count = std::min(piece, stream.bytes.size() - at);
      if (reeb::Status s = decoder->push({stream.bytes.data() + at, count}); !s.ok()) return s;
    }
    return decoder->finish();
  }

  void play(const Stream& stream) {
    reeb::DecodeOptions options;
    options.threads = 1 + static_cast<unsigned>(below(2));
    options.prefetch = below(4) > 0;
    options.cache_bytes = below(2) > 0 ? 1 : options.cache_bytes;
    const bool tight = below(4) == 0;
    if (tight) options.limits.max_memory = 1 + below(2 * stream.memory);
    std::unique_ptr<reeb::Decoder> decoder;
    const reeb::Status opened = open(stream, options, decoder);
    if (!opened.ok()) {
      note(opened, tight, false);
      return;
    }
    std::atomic<bool> over{false};
    const bool cancels = below(3) == 0;
    std::thread canceller([&] {
      for (unsigned i = 0; cancels && !over; ++i) {
        std::this_thread::sleep_for(std::chrono::microseconds(50 + i * 37 % 900));
        decoder->cancel();
      }
    });
    walk(stream, *decoder, tight, cancels);
    over = true;
    canceller.join();
  }  // closes, whatever is decoded ahead

  void walk(const Stream& stream, reeb::Decoder& decoder, bool tight, bool cancels) {
    std::vector<float> xyz;
    const size_t count = stream.frames.size();
    size_t frame = below(count);
    for (size_t calls = below(40); calls > 0; --calls) {
      frame = below(8) == 0 ? below(count) : (frame + (below(5) == 0 ? count - 1 : 1)) % count;
      const reeb::Status status = decode(decoder, static_cast<uint32_t>(frame), xyz);
      note(status, tight, cancels);
      if (!status.ok()) continue;
      const std::vector<float>& expected = stream.frames[frame];
      const bool same = xyz.size() == expected.size() &&
                        std::memcmp(xyz.data(), expected.data(), xyz.size() * sizeof(float)) == 0;
      faults_ += same ? 0 : 1;
      ++frames_;
    }
  }

  void note(const reeb::Status& status, bool tight, bool cancels) {
    const bool excused = status.ok() ||
                         (tight && status.code() == reeb::StatusCode::kLimitExceeded) ||
                         (cancels && status.code() == reeb::StatusCode::kCancelled);
    if (excused) return;
    std::fprintf(stderr, "soak: %s\n", status.message().c_str());
    ++faults_;
  }

  const std::vector<Stream>& streams_;
  std::mt19937 random_;
  uint64_t frames_ = 0, faults_ = 0;
};

/// Bytes in use; 0 where the C library does not tell.
size_t heap() {
#ifdef __GLIBC__
  return mallinfo2().uordblks + mallinfo2().hblkhd;
#else
  return 0;
#endif
}

/// Frames that were given, and what went wrong.
struct Sum {
  uint64_t frames = 0, faults = 0;
};

Sum soak(const std::vector<Stream>& streams, std::chrono::duration<double> time, unsigned seed) {
  constexpr unsigned kHosts = 4;
  std::vector<Host> hosts;
  for (unsigned i = 0; i < kHosts; ++i) hosts.emplace_back(streams, seed + i);
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
  std::vector<std::thread> threads;
  for (Host& host : hosts) threads.emplace_back([&host, end] { host.run(end); });
  for (std::thread& thread : threads) thread.join();
  Sum sum;
  for (const Host& host : hosts) {
    sum.frames += host.frames();
    sum.faults += host.faults();
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: soak SECONDS STREAM...\n");
    return 2;
  }
  std::vector<Stream> streams(static_cast<size_t>(argc) - 2);
  for (int i = 2; i < argc; ++i) {
    if (load(argv[i], streams[static_cast<size_t>(i) - 2])) continue;
    std::fprintf(stderr, "soak: %s does not decode\n", argv[i]);
    return 1;
  }
  const std::chrono::duration<double> time(std::atof(argv[1]));
  const Sum first = soak(streams, time / 4, 1);  // what stays for good is there then
  const size_t before = heap();
  const Sum rest = soak(streams, time * 3 / 4, 1001);
  const size_t after = heap();
  constexpr size_t kLittle = size_t{1} << 20;
  const bool lost = after > before + kLittle;
  const uint64_t faults = first.faults + rest.faults;
  std::printf("%zu streams, %llu frames, %llu faults, heap %zu and then %zu bytes\n",
              streams.size(), static_cast<unsigned long long>(first.frames + rest.frames),
              static_cast<unsigned long long>(faults), before, after);
  return lost || faults > 0 ? 1 : 0;
}
