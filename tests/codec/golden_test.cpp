// Streams made by the product and checksums of what they decode to. They fix the format: a decoder
// that gives other positions is wrong. See tests/README.md for making them anew.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "bitstream/bytes.h"
#include "bitstream/crc32c.h"
#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

const std::filesystem::path kFolder = REEB_TEST_DATA;

struct Golden {
  std::string name;
  Sequence sequence;
  EncodeOptions options;
};

std::vector<Golden> goldens() {
  std::vector<Golden> out(8);
  out[0] = {"main", sequence_of({animate(torus(24, 14), 20)}), quick_options()};
  out[0].options.target_value = 0.05;
  out[0].options.regions = 6;
  out[1] = {"fast", sequence_of({animate(with_isolated(grid(20, 15), 5), 12)}), quick_options()};
  out[1].options.profile = Profile::kFast;
  out[1].options.group_length = 5;
  out[1].options.regions = 4;
  out[2] = {"shots",
            sequence_of(
                {animate(mixed_polygons(), 6), animate(fins(7), 1), animate(with_duplicates(), 4)}),
            quick_options()};
  out[2].sequence.frame_rate = 24;
  out[2].sequence.metadata = {{"name", "golden"}};
  out[3] = {"thesis", sequence_of({animate(torus(12, 9), 5)}), quick_options()};
  out[3].options.profile = Profile::kThesis;
  out[3].options.regions = 3;
  out[4] = {"bounded", sequence_of({animate(torus(18, 12), 10)}), quick_options()};
  out[4].options.target = Target::kMaxError;
  out[4].options.target_value = 1e-3;
  out[5] = {"open", sequence_of({animate(torus(20, 12), 20)}), quick_options()};
  out[5].options.group_length = 6;
  out[5].options.open_groups = 2;
  out[6] = {"lossless", sequence_of({animate(mixed_polygons(), 9), animate(torus(14, 9), 6)}),
            quick_options()};
  out[6].options.target = Target::kLossless;
  out[7] = {"quick", sequence_of({animate(with_isolated(grid(12, 9), 5), 16)}), quick_options()};
  out[7].options.target = Target::kLossless;
  out[7].options.effort = 1;
  out[7].options.group_length = 10;
  // Decimals, and a frame that comes again.
  std::vector<float>& xyz = out[7].sequence.shots[0].positions;
  for (float& x : xyz) x = std::round(x * 1000.0f) / 1000.0f;
  const auto frame = static_cast<std::ptrdiff_t>(xyz.size() / 16);
  std::copy_n(xyz.begin() + frame, frame, xyz.begin() + 4 * frame);
  return out;
}

/// CRC-32C of sizes, faces and positions, numbers as 32 little-endian bits.
uint32_t checksum(const Sequence& sequence) {
  Bytes bytes;
  for (const Shot& shot : sequence.shots) {
    append_u32(bytes, shot.frame_count);
    append_u32(bytes, shot.connectivity.vertex_count);
    for (const uint32_t size : shot.connectivity.face_sizes) append_u32(bytes, size);
    for (const uint32_t corner : shot.connectivity.corners) append_u32(bytes, corner);
    for (const float x : shot.positions) append_f32(bytes, x);
  }
  return crc32c(bytes);
}

Bytes read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

void write_goldens() {
  std::ofstream list(kFolder / "expected.txt");
  for (const Golden& g : goldens()) {
    const Bytes bytes = encode_or_fail(g.sequence, g.options).bytes;
    std::ofstream(kFolder / (g.name + ".reeb"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
    list << g.name << ' ' << std::hex << checksum(decode_or_fail(bytes)) << std::dec << '\n';
  }
}

}  // namespace

TEST_CASE("golden streams decode to the positions they were made with", "[golden]") {
  if (std::getenv("REEB_WRITE_GOLDEN") != nullptr) write_goldens();
  std::ifstream list(kFolder / "expected.txt");
  std::string name;
  uint32_t expected = 0;
  int count = 0;
  while (list >> name >> std::hex >> expected) {
    INFO(name);
    const Bytes bytes = read_file(kFolder / (name + ".reeb"));
    REQUIRE_FALSE(bytes.empty());
    CHECK(bytes.size() < 20'000);
    CHECK(checksum(decode_or_fail(bytes, 1)) == expected);
    CHECK(checksum(decode_or_fail(bytes, 3)) == expected);
    ++count;
  }
  CHECK(count == 8);
}

TEST_CASE("golden streams keep the error they were made with", "[golden]") {
  for (const Golden& g : goldens()) {
    INFO(g.name);
    const Sequence decoded = decode_or_fail(read_file(kFolder / (g.name + ".reeb")));
    const Errors errors = measure(g.sequence, decoded);
    const bool bounded = g.options.target == Target::kMaxError;
    CHECK((bounded ? errors.largest : errors.kg / 1.0001) <= g.options.target_value);
  }
}
