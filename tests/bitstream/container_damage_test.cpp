// Cuts and flipped bits: what is whole is found, nothing else happens.
#include <catch2/catch.hpp>
#include <random>

#include "test_file.h"

using namespace reeb;
using namespace reeb::test;

namespace {

uint64_t section_sum(const ContainerReader& r) {
  uint64_t sum = 0;
  for (const auto& section : r.sections) sum += section.second;
  return sum;
}

bool has_group(const ContainerReader& r, const GroupChunk& wanted) {
  for (const GroupChunk& g : r.groups) {
    if (g.header == wanted.header && g.offset == wanted.offset) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("every cut keeps the whole groups before it", "[container]") {
  const Bytes file = two_shot_file();
  ContainerReader whole;
  REQUIRE(whole.parse(file, {}).ok());
  const size_t head_end = 8 + 4 + 1 + 7 + 4;  // signature, then HEAD with 7 bytes of payload
  for (size_t n = 0; n < file.size(); ++n) {
    const Bytes cut(file.begin(), file.begin() + static_cast<long>(n));
    ContainerReader r;
    const Status status = r.parse(cut, {});
    if (n < head_end) {
      CHECK(status.code() == StatusCode::kTruncated);
      continue;
    }
    REQUIRE(status.ok());
    CHECK(r.truncated);
    CHECK(section_sum(r) == n);
    size_t expected = 0;
    for (const GroupChunk& g : whole.groups) expected += g.offset + g.size <= n ? 1 : 0;
    CHECK(r.groups.size() == expected);
  }
}

TEST_CASE("a flipped bit costs at most the chunk it is in", "[container]") {
  const Bytes file = two_shot_file();
  ContainerReader whole;
  REQUIRE(whole.parse(file, {}).ok());
  const uint64_t head_end = 8 + 4 + 1 + 7 + 4;
  for (size_t bit = 0; bit < file.size() * 8; ++bit) {
    Bytes flipped = file;
    flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    ContainerReader r;
    const Status status = r.parse(flipped, {});
    if (bit / 8 < head_end) {
      CHECK_FALSE(status.ok());
      continue;
    }
    REQUIRE(status.ok());
    CHECK(r.damaged.size() + r.truncated >= 1);
    CHECK(section_sum(r) == file.size());
    for (const GroupChunk& g : whole.groups) {
      const bool hit = bit / 8 >= g.offset && bit / 8 < g.offset + g.size;
      CHECK(has_group(r, g) == !hit);
    }
  }
}

TEST_CASE("damage without a seek table still finds what follows a readable length", "[container]") {
  Bytes file = two_shot_file();
  ContainerReader whole;
  REQUIRE(whole.parse(file, {}).ok());
  const GroupChunk first = whole.groups[0];
  file[first.offset + first.size - 10] ^= 1;
  file.resize(file.size() - 8);  // the trailer is gone, so the table cannot be found
  ContainerReader r;
  REQUIRE(r.parse(file, {}).ok());
  CHECK(r.groups.size() == 2);
  CHECK(r.truncated);
  REQUIRE(r.damaged.size() == 1);
  CHECK(r.damaged[0].type == "GRUP");
  CHECK(r.damaged[0].offset == first.offset);
  CHECK(r.damaged[0].size == first.size);
}

TEST_CASE("a lost reference mesh leaves its groups without one", "[container]") {
  Bytes file = two_shot_file();
  ContainerReader whole;
  REQUIRE(whole.parse(file, {}).ok());
  file[whole.references[1].offset + 8] ^= 1;
  ContainerReader r;
  REQUIRE(r.parse(file, {}).ok());
  CHECK(r.groups.size() == 3);
  CHECK(r.reference(0) != nullptr);
  CHECK(r.reference(1) == nullptr);
}

TEST_CASE("bytes after the end are reported", "[container]") {
  Bytes file = two_shot_file();
  file.insert(file.end(), 20, 'x');
  ContainerReader r;
  REQUIRE(r.parse(file, {}).ok());
  CHECK(r.groups.size() == 3);
  CHECK_FALSE(r.truncated);
  CHECK(r.damaged.size() == 1);
}

TEST_CASE("a length past the end allocates nothing and ends the file", "[container]") {
  Bytes file;
  ContainerWriter writer(file);
  REQUIRE(writer.begin(SequenceHeader{}).ok());
  file.insert(file.end(), {'G', 'R', 'U', 'P', 0xFF, 0xFF, 0xFF, 0xFF, 0x7F, 1, 2, 3});
  ContainerReader r;
  REQUIRE(r.parse(file, {}).ok());
  CHECK(r.truncated);
  CHECK(r.groups.empty());
}

TEST_CASE("random bytes behind a right front never crash", "[container]") {
  std::mt19937 random(1);
  const Bytes file = two_shot_file();
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes = file;
    for (int k = 0; k < 1 + round % 8; ++k) {
      bytes[8 + random() % (bytes.size() - 8)] = static_cast<uint8_t>(random());
    }
    bytes.resize(8 + random() % (bytes.size() - 7));
    ContainerReader r;
    if (r.parse(bytes, {}).ok()) CHECK(section_sum(r) == bytes.size());
    CHECK_FALSE(trace(bytes).empty());
  }
}
