#include "bitstream/syntax.h"

#include <catch2/catch.hpp>
#include <limits>

#include "bitstream/headers.h"

using namespace reeb;
using Bytes = std::vector<uint8_t>;

namespace {

template <class Header>
Status read_from(const Bytes& bytes, Header& h) {
  ByteReader in(bytes);
  return read_header(in, "test", h);
}

template <class Header>
void check_round_trip(const Header& h) {
  Bytes bytes;
  REQUIRE(write_header(h, "test", bytes).ok());
  Header back;
  REQUIRE(read_from(bytes, back).ok());
  CHECK(back == h);
  for (size_t n = 0; n < bytes.size(); ++n) {
    CHECK(read_from(Bytes(bytes.begin(), bytes.begin() + static_cast<long>(n)), back).code() ==
          StatusCode::kCorrupt);
  }
}

}  // namespace

TEST_CASE("headers survive and their truncations fail", "[syntax]") {
  check_round_trip(SequenceHeader{400, 2, 29.97, -3.5, 0});
  check_round_trip(ReferenceHeader{1, 7, {1.5f, -2.25f, 1e-20f}, 0.125f, 0});
  check_round_trip(MeshHeader{.vertex_count = 3030,
                              .face_count = 5664,
                              .flags = MeshHeader::kOrderKept,
                              .draco_bytes = 1,
                              .rest_bytes = 300,
                              .order_bytes = 70000});
  check_round_trip(MeshHeader{.vertex_count = 3030,
                              .face_count = 5664,
                              .flags = MeshHeader::kPlain | MeshHeader::kFaceOrderKept,
                              .draco_bytes = 1,
                              .rest_bytes = 300,
                              .position_bytes = 5,
                              .order_bytes = 0,
                              .face_bytes = 7});
  GroupHeader group;
  group.first_frame = 64;
  group.frame_count = 65536;
  group.shot = 1;
  group.profile = Profile::kFast;
  group.component_count = 12;
  group.quantization_step = 0.5f;
  group.region_count = 24;
  group.motion_bytes = 1;
  group.coefficient_bytes = 200;
  group.basis_bytes = 70000;
  check_round_trip(group);
  check_round_trip(SeekEntry{0, 9, 3});
}

TEST_CASE("a sequence header has the specified bytes", "[syntax]") {
  Bytes bytes;
  REQUIRE(write_header(SequenceHeader{300, 1, 30.0, 0.0, 0}, "HEAD", bytes).ok());
  CHECK(bytes == Bytes{0xAC, 0x02, 1, 2, 0x40, 0x3E, 0, 0});
}

TEST_CASE("a range violation names header and field", "[syntax]") {
  SequenceHeader h;
  const Status zero_frames = read_from({0, 1, 0, 0, 0}, h);
  CHECK(zero_frames.code() == StatusCode::kCorrupt);
  CHECK(zero_frames.message() == "test: total_frames is out of range: 0");
  const Status many_shots = read_from({2, 3, 0, 0, 0}, h);
  CHECK(many_shots.message() == "test: shot_count is out of range: 3");
  CHECK(h.shot_count == 1);  // left in range
  const Status reserved = read_from({2, 1, 0, 0, 4}, h);
  CHECK(reserved.message() == "test: flags has reserved bits set");
}

TEST_CASE("numbers that are none are refused", "[syntax]") {
  for (const float bad : {0.0f, -1.0f, std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()}) {
    GroupHeader h;
    h.quantization_step = bad;
    Bytes bytes;
    const Status written = write_header(h, "GRUP", bytes);
    CHECK(written.code() == StatusCode::kInvalidArgument);
    const Status read = read_from(bytes, h);
    CHECK(read.code() == StatusCode::kCorrupt);
    CHECK(read.message().find("quantization_step") != std::string::npos);
  }
}

TEST_CASE("the writer refuses what the reader would", "[syntax]") {
  Bytes bytes;
  GroupHeader group;
  group.frame_count = kMaxGroupFrames + 1;
  CHECK(write_header(group, "GRUP", bytes).code() == StatusCode::kInvalidArgument);
  MeshHeader mesh;
  mesh.flags = 0x80;
  CHECK(write_header(mesh, "mesh", bytes).code() == StatusCode::kInvalidArgument);
}

TEST_CASE("a list cannot promise more than its bytes hold", "[syntax]") {
  SeekTable table;
  Bytes bytes;
  append_varuint(bytes, uint64_t{1} << 60);
  bytes.insert(bytes.end(), 30, 9);
  const Status s = read_from(bytes, table);
  CHECK(s.code() == StatusCode::kCorrupt);
  CHECK(table.entries.empty());
}
