#include "codec/enc/fields/stop_rule.h"

#include <catch2/catch.hpp>

namespace reeb {

TEST_CASE("components are kept while they pay, with their padding", "[stop_rule]") {
  constexpr uint32_t kFrames = 10;
  const auto kept = [](uint32_t vertices, double energy) {
    StopRule stop(vertices, kFrames, 0.1);
    for (int k = 0; k < 20 && stop.add(energy, 0, 1); ++k) {
    }
    return stop.best();
  };
  // Each spares 100 units, and costs 60 / 12 and a tenth of its bits: 1 and those of its basis.
  CHECK(kept(50, 100) == 20);
  CHECK(kept(50, 6) == 0);
  // 64,000 vertices and 30 values make 64,030 / 512 bytes of a component at least: 1,000 bits.
  CHECK(kept(64000, 100) == 0);
  CHECK(kept(64000, 110) == 20);
}

TEST_CASE("padding is shared by components that need none", "[stop_rule]") {
  StopRule stop(64000, 10, 0.1);
  stop.add(1e6, 0, 3500);  // enough for three more that are coded in next to nothing
  for (int k = 0; k < 3; ++k) stop.add(10, 0, 0);
  CHECK(stop.best() == 4);
  CHECK(stop.bits() < 4100);
  for (int k = 0; k < 3; ++k) stop.add(10, 0, 0);
  CHECK(stop.best() == 4);
  CHECK(stop.bits() > 7000);
}

}  // namespace reeb
