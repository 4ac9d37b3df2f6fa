#include "tools/io/frame_order.h"

#include <algorithm>
#include <catch2/catch.hpp>

namespace reeb::tools {
namespace {

using Names = std::vector<std::string>;
using Catch::Contains;

FrameOrder order_of(const Names& names) { return order_by_name({names.begin(), names.end()}); }

/// `names` in the order that they are to have, whatever order they come in.
void check_order(const Names& names) {
  INFO(names[0] << " ... " << names.back());
  for (const bool reversed : {false, true}) {
    Names given = names;
    std::sort(given.begin(), given.end());
    if (reversed) std::reverse(given.begin(), given.end());
    const FrameOrder order = order_of(given);
    Names found;
    for (const auto& file : order.files) found.push_back(file.string());
    CHECK(found == names);
    CHECK(order.doubt.empty());
    CHECK(order.gap.empty());
  }
}

}  // namespace

TEST_CASE("numbers in names are compared by value") {
  CHECK(natural_less("f2.obj", "f10.obj"));
  CHECK_FALSE(natural_less("f10.obj", "f2.obj"));
  CHECK(natural_less("f009.obj", "f10.obj"));
  CHECK(natural_less("a2b10", "a2b11"));
  CHECK(natural_less("a", "b"));
  CHECK_FALSE(natural_less("f1", "f1"));
  // Equal in value: the order is still total.
  CHECK(natural_less("f01", "f1") != natural_less("f1", "f01"));
  CHECK(natural_less("f99999999999999999999998", "f99999999999999999999999"));
}

TEST_CASE("names of frames are put in order") {
  check_order({"f8.obj", "f9.obj", "f10.obj", "f11.obj"});
  check_order({"f_-2.obj", "f_-1.obj", "f_0.obj", "f_1.obj"});
  check_order({"f-2.obj", "f-1.obj", "f0.obj", "f1.obj"});
  check_order({"f-1.obj", "f-2.obj", "f-3.obj"});
  check_order({"f_-0010.obj", "f_-0009.obj", "f_-0008.obj"});
  check_order({"-1.obj", "0.obj", "1.obj"});
  check_order({"R-0.0005.obj", "R-0.001.obj", "R-0.0015.obj", "R-0.002.obj"});
  check_order({"t0.obj", "t0.5.obj", "t1.obj", "t1.5.obj", "t2.obj"});
  check_order({"t_-0.5.obj", "t_-0.25.obj", "t_0.obj", "t_0.25.obj"});
  check_order({"t0.25.obj", "t0.5.obj", "t0.75.obj"});
  check_order({"t0.98.obj", "t0.99.obj", "t1.00.obj", "t1.01.obj"});
  check_order({"take1.8.obj", "take1.9.obj", "take1.10.obj", "take1.11.obj"});
  check_order({"take1_f0.obj", "take1_f1.obj", "take2_f0.obj", "take2_f1.obj"});
  check_order({"f_1_t0.0333.obj", "f_2_t0.0667.obj", "f_3_t0.1.obj", "f_4_t0.1333.obj"});
  check_order({"a/s1.2.3_9.obj", "a/s1.2.3_10.obj"});
  check_order({"sim.0001.obj", "sim.0002.obj"});
  check_order({"scan_99999999999999999999998.obj", "scan_99999999999999999999999.obj"});
  check_order({"finish.obj", "start.obj"});
}

TEST_CASE("a number that skips is named") {
  CHECK_THAT(order_of({"w_08", "w_09", "w_11"}).gap, Contains("w_10: frame 10 is missing"));
  CHECK_THAT(order_of({"f_-3", "f_-1", "f_0"}).gap, Contains("f_-2: frame -2 is missing"));
  CHECK_THAT(order_of({"f_-001", "f_001"}).gap, Contains("f_000: frame 0 is missing"));
  CHECK_THAT(order_of({"s3_f1_v2", "s3_f2_v2", "s3_f4_v2"}).gap, Contains("s3_f3_v2:"));
  CHECK_THAT(order_of({"a1_f0", "a1_f1", "a1_f3", "a2_f0"}).gap, Contains("a1_f2:"));
  CHECK_THAT(order_of({"a1_f0", "a1_f1", "a3_f0", "a3_f1"}).gap, Contains("frame 2 is missing"));
  CHECK_THAT(order_of({"t0.1", "t0.2", "t0.4"}).gap, Contains("t0.3: frame 3 is missing"));
  CHECK_THAT(order_of({"t0", "t0.5", "t1.5"}).gap,
             Contains("a frame is missing between t0.5 and t1.5"));
  CHECK(order_of({"t0.0333", "t0.0667", "t0.1"}).gap.empty());
}

TEST_CASE("where a number skips, zeros show whether the numbers are decimals") {
  const FrameOrder times = order_of({"t0.002", "t0.0005", "t0.001"});
  CHECK(times.files[0] == "t0.0005");
  CHECK_THAT(times.gap, Contains("a frame is missing between t0.001 and t0.002"));
  const FrameOrder takes = order_of({"take1.10", "take1.11", "take1.8"});
  CHECK(takes.files[0] == "take1.8");
  CHECK_THAT(takes.gap, Contains("take1.9: frame 9 is missing"));
}

TEST_CASE("names that are not those of one sequence leave a doubt") {
  CHECK_THAT(order_of({"f_1", "f_2", "f_2 copy", "f_5"}).doubt,
             Contains("f_2 copy: not named like f_1 and 2 more"));
  CHECK_THAT(order_of({"rest", "f_1", "f_2"}).doubt, Contains("rest: not named like"));
  CHECK_THAT(order_of({"f_1", "f_01"}).doubt, Contains("two files have one frame number"));
  CHECK_THAT(order_of({"f_0", "f_-0"}).doubt, Contains("two files have one frame number"));
  // 1.1 and 1.2 may be missing, or 1.10.
  CHECK_THAT(order_of({"v1.8", "v1.9", "v1.11", "v1.12"}).doubt, Contains("decimals or not"));
  CHECK_THAT(order_of({"f_-3", "f_-2", "f_-1"}).note, Contains("f_-3 to f_-1: taken for negative"));
  CHECK(order_of({"f_-1", "f_0"}).note.empty());
}

}  // namespace reeb::tools
