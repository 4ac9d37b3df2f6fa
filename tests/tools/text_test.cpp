#include "tools/text.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace reeb::tools {

TEST_CASE("numbers for people") {
  CHECK(grouped(0) == "0");
  CHECK(grouped(999) == "999");
  CHECK(grouped(1000) == "1,000");
  CHECK(grouped(1234567) == "1,234,567");
  CHECK(brief(0.123456) == "0.1235");
  CHECK(brief(1e-9, 2) == "1e-09");
  CHECK(brief(INFINITY) == "inf");
  CHECK(plain(3012, 3) == "3,010");
  CHECK(plain(1234567.8, 4) == "1,235,000");
  CHECK(plain(12345.678, 7) == "12,345.68");
  CHECK(plain(-0.000054321, 2) == "-0.000054");
  CHECK(plain(0.5) == "0.5");
  CHECK(plain(9.99996) == "10");
  CHECK(plain(0) == "0");
  CHECK(plain(1e-9, 2) == "1e-09");
  CHECK(plain(INFINITY) == "inf");
  CHECK(counted(1, "frame") == "1 frame");
  CHECK(counted(0, "frame") == "0 frames");
  CHECK(counted(4210, "vertex") == "4,210 vertices");
  CHECK(byte_size(9999) == "9,999 bytes");
  CHECK(byte_size(1234567) == "1.235 MB");
  CHECK(byte_size(12345) == "12.35 kB");
  CHECK(byte_size(2'000'000'000) == "2 GB");
}

}  // namespace reeb::tools
