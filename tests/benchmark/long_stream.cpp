// long_stream OUT PROFILE AROUND ACROSS GROUPS: writes a stream of AROUND * ACROSS vertices and
// GROUPS * 25 frames quickly, by encoding one group and repeating it. For
// tests/benchmark/playback.sh.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "bitstream/container.h"
#include "codec/enc/encoder.h"
#include "tests/codec/shapes.h"

namespace {

constexpr uint32_t kGroupFrames = 25;

reeb::Status repeat_group(const std::vector<uint8_t>& one, uint32_t groups,
                          std::vector<uint8_t>& out) {
  reeb::ContainerReader in;
  if (reeb::Status s = in.parse(one, {}); !s.ok()) return s;
  reeb::ContainerWriter writer(out);
  in.header.total_frames = kGroupFrames * groups;
  in.header.frame_rate = 25;
  if (reeb::Status s = writer.begin(in.header); !s.ok()) return s;
  if (reeb::Status s = writer.reference(in.references[0].header, in.references[0].mesh); !s.ok())
    return s;
  reeb::GroupChunk& group = in.groups[0];
  for (uint32_t g = 0; g < groups; ++g) {
    group.header.first_frame = g * kGroupFrames;
    if (reeb::Status s = writer.group(group.header, group); !s.ok()) return s;
  }
  return writer.finish();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fputs("usage: long_stream OUT main|fast AROUND ACROSS GROUPS\n", stderr);
    return 2;
  }
  const auto number = [argv](int i) { return static_cast<uint32_t>(std::atoi(argv[i])); };
  reeb::Sequence sequence;
  sequence.shots.push_back(
      reeb::test::animate(reeb::test::torus(number(3), number(4)), kGroupFrames));
  reeb::EncodeOptions options;
  options.target_value = 0.05;
  options.group_length = kGroupFrames;
  options.effort = reeb::kMinEffort;
  if (std::string(argv[2]) == "fast") options.profile = reeb::Profile::kFast;
  std::vector<uint8_t> one, out;
  reeb::EncodeStats stats;
  reeb::Status status = reeb::encode(sequence, options, one, stats);
  if (status.ok()) status = repeat_group(one, number(5), out);
  if (!status.ok()) {
    std::fprintf(stderr, "long_stream: %s\n", status.message().c_str());
    return 1;
  }
  std::ofstream(argv[1], std::ios::binary)
      .write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(out.size()));
  return 0;
}
