#include "codec/enc/search/rate_model.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "codec/enc/search/profile_tools.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// A wave that runs over the torus, with a little of a finer one.
void wave(const float* rest, double time, double* xyz) {
  for (int a = 0; a < 3; ++a) {
    const double x = static_cast<double>(rest[a]);
    xyz[a] = x + 0.3 * std::sin(6 * time + x) + 0.02 * std::sin(40 * time + 9 * x + a);
  }
}

GroupSettings at(double q, std::optional<uint32_t> components = {}) {
  return {.q = q, .weak_prior = false, .components = components};
}

struct Group {
  explicit Group(Profile profile)
      : shot(animate(torus(40, 24), 24, wave)),
        plan(shot.connectivity),
        encoder(tools_of(profile).make_encoder(make_group_signal(shot, 0, 24), 1)) {
    const bool fast = profile == Profile::kFast;
    const ReferenceOptions options{.plain = fast};
    REQUIRE(make_surface_context(shot, plan, 12, options, surface).ok());
  }
  CodedGroup encode(double q) {
    GroupRun run;
    return encoder->encode(surface, at(q), nullptr, run);
  }
  Shot shot;
  ReferencePlan plan;
  std::unique_ptr<GroupEncoder> encoder;
  SurfaceContext surface;
};

}  // namespace

TEST_CASE("what is expected of a group is about what comes", "[rate_model]") {
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    Group group(profile);
    for (const double q : {0.3, 0.05, 0.008}) {
      const RatePoint expected = group.encoder->expect(group.surface, at(q));
      const CodedGroup coded = group.encode(q);
      const auto bytes = static_cast<double>(coded.coefficients.size() + coded.basis.size());
      INFO("profile " << static_cast<int>(profile) << ", q " << q);
      CHECK(std::abs(std::log(expected.bits / (8 * bytes))) < std::log(2.0));
      CHECK(std::abs(std::log(expected.distortion / coded.squared_error)) < std::log(2.0));
    }
  }
}

TEST_CASE("what is expected falls and grows with the step", "[rate_model]") {
  Group group(Profile::kMain);
  RatePoint before = group.encoder->expect(group.surface, at(1e-3));
  for (double q = 1.5e-3; q < 2; q *= 1.5) {
    const RatePoint point = group.encoder->expect(group.surface, at(q));
    CHECK(point.bits < before.bits);
    CHECK(point.distortion > before.distortion);
    before = point;
  }
}

TEST_CASE("held components are what is expected to be sent", "[rate_model]") {
  Group group(Profile::kMain);
  const RatePoint all = group.encoder->expect(group.surface, at(0.01));
  const RatePoint two = group.encoder->expect(group.surface, at(0.01, 2));
  CHECK(two.bits < all.bits);
  CHECK(two.distortion > all.distortion);
  const RatePoint none = group.encoder->expect(group.surface, at(0.01, 0));
  CHECK(none.bits == 0);
  CHECK(none.distortion == Approx(group.encoder->signal().energy).epsilon(1e-3));
}
