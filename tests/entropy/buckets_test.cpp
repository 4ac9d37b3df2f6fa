#include "entropy/buckets.h"

#include <catch2/catch.hpp>

using namespace reeb;

namespace {

/// Buckets follow each other without a gap; returns the first magnitude past `count` of them.
template <class Which>
uint64_t check_tiles(uint32_t count) {
  uint64_t next = 0;
  for (uint32_t b = 0; b < count; ++b) {
    REQUIRE(Which::begin(b) == next);
    REQUIRE(Which::of(next) == b);
    next += uint64_t{1} << Which::extra_bits(b);
    REQUIRE(Which::of(next - 1) == b);
  }
  return next;
}

}  // namespace

TEST_CASE("buckets tile the magnitudes, as many to each octave as they should", "[buckets]") {
  // Eight single values reach 8; every octave from there on doubles.
  CHECK(check_tiles<Buckets<1>>(8 + 1 * 10) == 8u << 10);
  CHECK(check_tiles<Buckets<2>>(8 + 2 * 10) == 8u << 10);
  CHECK(check_tiles<Buckets<4>>(8 + 4 * 10) == 8u << 10);
  CHECK(check_tiles<Buckets<8>>(8 + 8 * 10) == 8u << 10);
}
