#include "tools/attribute_rules.h"

#include <catch2/catch.hpp>

#include "tools/frame_selection.h"
#include "tools/io/attribute_values.h"

namespace reeb::tools {
namespace {

using Catch::Contains;

Sequence sample() {
  Sequence out;
  Shot& shot = out.shots.emplace_back();
  shot.connectivity = {3, {3}, {0, 1, 2}};
  shot.frame_count = 2;
  shot.positions.resize(18);
  shot.attributes = {
      make_attribute("vt", Semantic::kTextureCoordinate, Domain::kCorner, ValueType::kBinary32, 2,
                     std::vector<float>{0, 0, 0.5f, 3, 1, 1}),
      make_attribute("vn", Semantic::kNormal, Domain::kCorner, ValueType::kBinary32, 3,
                     std::vector<float>(9, 1.0f)),
      make_attribute("heat", Semantic::kGeneric, Domain::kVertex, ValueType::kBinary32, 1,
                     std::vector<float>{1, 2, 3, 4, 5, 9}),
      make_attribute("usemtl", Semantic::kMaterial, Domain::kFace, ValueType::kI32, 1,
                     std::vector<int32_t>{0})};
  shot.attributes[2].animated = true;
  return out;
}

AttributeRule rule(const std::string& text) {
  AttributeRule out;
  INFO(text);
  REQUIRE(parse_attribute_rule(text, out).empty());
  return out;
}

}  // namespace

TEST_CASE("patterns of attribute names") {
  CHECK(fits_pattern("vt", "vt"));
  CHECK(fits_pattern("vt", "*"));
  CHECK(fits_pattern("", "*"));
  CHECK(fits_pattern("vt.index", "v*.in*x"));
  CHECK(fits_pattern("vt", "?t"));
  CHECK(fits_pattern("aab", "*ab"));
  CHECK_FALSE(fits_pattern("vt", "v"));
  CHECK_FALSE(fits_pattern("v", "vt"));
  CHECK_FALSE(fits_pattern("vt", "?"));
  CHECK_FALSE(fits_pattern("aba", "*ab"));
}

TEST_CASE("rules of attributes, good and bad") {
  CHECK(rule("vt=bits:12").value == 12);
  CHECK(rule("a=b=drop").names == "a=b");
  CHECK(rule("vn=compute").value == 2);
  CHECK(rule("vn=compute:5").value == 5);
  CHECK(rule("x=error:0.25").value == 0.25);
  for (const char* bad :
       {"vt", "=drop", "vt=", "vt=bits", "vt=bits:0", "vt=bits:25", "vt=bits:1.5", "vt=error:-1",
        "vt=error:x", "vt=exact:1", "vt=drop:1", "vn=compute:181", "vt=error:nan"}) {
    AttributeRule out;
    INFO(bad);
    CHECK_FALSE(parse_attribute_rule(bad, out).empty());
  }
}

TEST_CASE("defaults of attributes, with and without a loss") {
  Sequence sequence = sample();
  CHECK(apply_attribute_rules({}, false, sequence).empty());
  const auto& a = sequence.shots[0].attributes;
  CHECK(a[0].max_error == std::vector<double>{1.0 / 8192, 1.0 / 8192});
  CHECK(a[1].max_angle == 2);
  CHECK(a[1].max_error == std::vector<double>(3, 1.0 / 1024));
  CHECK(a[2].max_error == std::vector<double>{8.0 / 131072});  // the range of both frames
  CHECK(a[3].max_error.empty());
  Sequence exact = sample();
  CHECK(apply_attribute_rules({}, true, exact).empty());
  for (const Attribute& kept : exact.shots[0].attributes) {
    CHECK(kept.max_error.empty());
    CHECK(kept.max_angle == 0);
  }
}

TEST_CASE("the last rule that fits counts, and one that fits nothing is told") {
  Sequence sequence = sample();
  const auto notes = apply_attribute_rules(
      {rule("*=drop"), rule("v?=exact"), rule("vt=error:0.5"), rule("gone=drop")}, false, sequence);
  const auto& a = sequence.shots[0].attributes;
  REQUIRE(a.size() == 2);
  CHECK(a[0].max_error == std::vector<double>{0.5, 0.5});
  CHECK(a[1].max_error.empty());
  CHECK(a[1].max_angle == 0);
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0], Contains("there is no \"gone\"") && Contains("heat"));
}

TEST_CASE("picked frames keep attributes and files") {
  Sequence sequence = sample();
  sequence.resources = {{"a.mtl", "model/mtl", {1, 2}}};
  const Sequence picked = pick_frames(sequence, {2, 1, 2});
  REQUIRE(picked.shots.size() == 1);
  const auto& a = picked.shots[0].attributes;
  REQUIRE(a.size() == 4);
  CHECK(a[0] == sequence.shots[0].attributes[0]);
  std::vector<float> heat;
  for (size_t i = 0; i < 9; ++i) heat.push_back(a[2].get<float>(i));
  CHECK(heat == std::vector<float>{4, 5, 9, 1, 2, 3, 4, 5, 9});
  CHECK(a[2].values.size() == 36);
  CHECK(picked.resources == sequence.resources);
}

}  // namespace reeb::tools
