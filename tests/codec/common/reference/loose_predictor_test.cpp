#include "codec/common/reference/loose_predictor.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace reeb;

namespace {

/// Takes the place of an encoder and keeps what the value took of the range.
struct Share {
  double value = 0;
  void code(const Interval& interval) {
    value = static_cast<double>(interval.size) / static_cast<double>(interval.whole);
  }
};

/// The share of `value` behind `past`, a run along one axis that the kinds of guesses learned from.
double share_after(const std::vector<int32_t>& past, int32_t value, size_t axis = 0) {
  LoosePredictor predictor;
  GuessMixture mixture(LoosePredictor::kKindCount, LoosePredictor::kMemory);
  Share share;
  const auto code = [&](int32_t x) {
    predictor.guess(axis, mixture);
    mixture.code(share, static_cast<uint32_t>(x), 65536, predictor.likely(axis),
                 predictor.reach(axis));
    predictor.learn(axis, x);
  };
  for (const int32_t x : past) code(x);
  code(value);
  return share.value;
}

std::vector<int32_t> run(uint32_t count, int32_t (*value)(int32_t)) {
  std::vector<int32_t> out;
  for (uint32_t i = 0; i < count; ++i) out.push_back(value(static_cast<int32_t>(i)));
  return out;
}

}  // namespace

TEST_CASE("the next vertex lies where the last one does, where they went on, or one before",
          "[loose_predictor]") {
  const auto still = run(60, [](int32_t) { return 700; });
  CHECK(share_after(still, 700) > 20 * share_after(still, 703));
  const auto steady = run(60, [](int32_t i) { return 1000 + 37 * i; });
  CHECK(share_after(steady, 1000 + 37 * 60) > 10 * share_after(steady, 1000 + 37 * 59));
  CHECK(share_after(steady, 1000 + 37 * 60) > 10 * share_after(steady, 1000 + 37 * 60 + 20));
  const auto to_and_fro = run(60, [](int32_t i) { return i % 2 == 0 ? 2000 : 2037; });
  CHECK(share_after(to_and_fro, 2000) > 10 * share_after(to_and_fro, 2037));
}

TEST_CASE("each axis has its own past", "[loose_predictor]") {
  LoosePredictor predictor;
  predictor.learn(0, 100);
  predictor.learn(1, 3000);
  predictor.learn(2, 7);
  CHECK(predictor.likely(0) == 100);
  CHECK(predictor.likely(1) == 3000);
  CHECK(predictor.likely(2) == 7);
}

TEST_CASE("the reach is a sixteenth of the smoothed steps, and one", "[loose_predictor]") {
  LoosePredictor predictor;
  CHECK(predictor.reach(0) == 1);
  predictor.learn(0, 160);  // 160
  CHECK(predictor.reach(0) == 11);
  predictor.learn(0, 160);  // 160 - 10
  CHECK(predictor.reach(0) == 10);
  predictor.learn(0, 0);  // 150 - 9 + 160
  CHECK(predictor.reach(0) == 1 + 301 / 16);
  CHECK(predictor.reach(1) == 1);
}
