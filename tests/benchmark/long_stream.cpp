// long_stream OUT: writes a stream of 100,000 vertices and 2,000 frames quickly, by encoding one
// group and repeating it. For tests/benchmark/playback.sh.
#include <cstdio>
#include <fstream>

#include "bitstream/container.h"
#include "codec/enc/encoder.h"
#include "tests/codec/shapes.h"

namespace {

constexpr uint32_t kGroupFrames = 25;
constexpr uint32_t kGroups = 80;

reeb::Status repeat_group(const std::vector<uint8_t>& one, std::vector<uint8_t>& out) {
  reeb::ContainerReader in;
  if (reeb::Status s = in.parse(one, {}); !s.ok()) return s;
  reeb::ContainerWriter writer(out);
  in.header.total_frames = kGroupFrames * kGroups;
  in.header.frame_rate = 25;
  if (reeb::Status s = writer.begin(in.header); !s.ok()) return s;
  if (reeb::Status s = writer.reference(in.references[0].header, in.references[0].mesh); !s.ok())
    return s;
  reeb::GroupChunk& group = in.groups[0];
  for (uint32_t g = 0; g < kGroups; ++g) {
    group.header.first_frame = g * kGroupFrames;
    if (reeb::Status s = writer.group(group.header, group); !s.ok()) return s;
  }
  return writer.finish();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  reeb::Sequence sequence;
  sequence.shots.push_back(reeb::test::animate(reeb::test::torus(400, 250), kGroupFrames));
  reeb::EncodeOptions options;
  options.target_value = 0.05;
  options.group_length = kGroupFrames;
  if (argc > 2) options.profile = reeb::Profile::kFast;
  std::vector<uint8_t> one, out;
  reeb::EncodeStats stats;
  reeb::Status status = reeb::encode(sequence, options, one, stats);
  if (status.ok()) status = repeat_group(one, out);
  if (!status.ok()) {
    std::fprintf(stderr, "long_stream: %s\n", status.message().c_str());
    return 1;
  }
  std::ofstream(argv[1], std::ios::binary)
      .write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(out.size()));
  return 0;
}
