#include "codec/common/base/batches.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace reeb;

namespace {

struct alignas(64) Batch {
  uint32_t first, last;
  char rest[100];
};

}  // namespace

TEST_CASE("batches are aligned, and stay what they are when there are more of them") {
  BatchVector<Batch> batches;
  for (uint32_t i = 0; i < 200; ++i) {
    batches.push_back({i, ~i, {}});
    REQUIRE(reinterpret_cast<uintptr_t>(batches.data()) % alignof(Batch) == 0);
  }
  const BatchVector<Batch> copy = batches;
  batches.clear();
  batches.shrink_to_fit();
  for (uint32_t i = 0; i < 200; ++i) CHECK((copy[i].first == i && copy[i].last == ~i));
}

TEST_CASE("more batches than there can be are refused") {
  AligningAllocator<Batch> allocator;
  CHECK_THROWS_AS(allocator.allocate(std::numeric_limits<size_t>::max() / sizeof(Batch)),
                  std::bad_alloc);
}
