#include "bitstream/element_bound.h"

#include <catch2/catch.hpp>

using namespace reeb;

namespace {

GroupHeader main_group() {
  GroupHeader h;
  h.frame_count = 10;
  h.component_count = 4;
  h.region_count = 3;
  h.flags = GroupHeader::kCorrected;
  h.correction_count = 7;
  return h;
}

}  // namespace

TEST_CASE("elements are the values that a group announces", "[bound]") {
  // 4 planes of 100 vertices and 100 more, 5 of 30 coordinates, 3 * 4 transforms of 12, 7 * 8.
  CHECK(group_elements(main_group(), 100) == 500 + 150 + 144 + 56);
  GroupHeader exact;
  exact.profile = Profile::kLossless;
  exact.frame_count = 10;
  exact.stored_count = 4;
  CHECK(group_elements(exact, 100) == 4 * 300 + 100 + 30);
}

TEST_CASE("the largest header has a number of elements", "[bound]") {
  GroupHeader h;
  h.frame_count = kMaxGroupFrames;
  h.component_count = 3 * kMaxGroupFrames;
  h.region_count = UINT32_MAX;
  h.correction_count = uint64_t{3} * kMaxVertices * kMaxGroupFrames;
  CHECK(group_elements(h, kMaxVertices) / h.component_count > uint64_t{12} * UINT32_MAX);
  CHECK(!within_element_bound(h, kMaxVertices));
}

TEST_CASE("a byte less than the bound is refused", "[bound]") {
  GroupHeader h;
  h.frame_count = 1;
  h.component_count = 99;
  // (509 + 3) * 100 elements are 100 bytes, of which the header counts for 32.
  h.coefficient_bytes = 68;
  CHECK(within_element_bound(h, 509));
  CHECK(!within_element_bound(h, 510));
  h.coefficient_bytes = 60;
  h.basis_bytes = 7;
  CHECK(!within_element_bound(h, 509));
  h.correction_bytes = 1;
  CHECK(within_element_bound(h, 509));
}

TEST_CASE("zeros behind a section keep a group within the bound", "[bound]") {
  GroupHeader h;
  h.frame_count = 1;
  h.component_count = 99;
  const std::vector<uint8_t> some = {1, 2, 3};
  std::vector<uint8_t> padded;
  const GroupSections all =
      within_element_bound(h, 509, {.coefficients = some, .basis = some}, padded);
  REQUIRE(all.coefficients.size() == 65);  // and 3 of the basis
  CHECK(std::vector<uint8_t>(all.coefficients.begin(), all.coefficients.begin() + 4) ==
        std::vector<uint8_t>{1, 2, 3, 0});
  CHECK(all.basis.data() == some.data());

  const GroupSections odd =
      within_element_bound(h, 508, {.coefficients = some, .basis = some}, padded);
  CHECK(odd.coefficients.size() == 65);  // 100 * 511 elements: 64 would do, words have two bytes

  h.component_count = 20;
  const GroupSections few = within_element_bound(h, 509, {.coefficients = some}, padded);
  CHECK(few.coefficients.data() == some.data());

  h.profile = Profile::kLossless;
  h.stored_count = 1;
  const GroupSections frames = within_element_bound(h, 100'000, {.differences = some}, padded);
  // 400,003 elements
  CHECK((frames.differences.size() == 750 || frames.differences.size() == 751));
  CHECK(frames.coefficients.empty());
}
