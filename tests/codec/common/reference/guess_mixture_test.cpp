#include "codec/common/reference/guess_mixture.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace reeb;

namespace {

constexpr uint32_t kCount = 1000;

// Values that follow a guess within `noise`, now and then anything.
std::vector<uint32_t> noisy_values(std::mt19937& random, size_t count, uint32_t noise) {
  std::vector<uint32_t> out;
  for (size_t i = 0; i < count; ++i) {
    const auto jitter = static_cast<uint32_t>(random() % (noise + 1));
    out.push_back(random() % 20 == 0 ? static_cast<uint32_t>(random() % kCount) : 500 + jitter);
  }
  return out;
}

void set_guesses(GuessMixture& mixture) {
  mixture.clear();
  mixture.add(0, 500 << 8, 4 << 8);
  mixture.add(1, -70000, 1);          // far off the range
  mixture.add(2, 2000000, 16777216);  // far off, as wide as can be
}

template <class Coder>
std::vector<uint32_t> run(Coder& coder, std::vector<uint32_t> values, uint32_t likely,
                          uint64_t reach) {
  GuessMixture mixture(3, 64);
  for (uint32_t& v : values) {
    set_guesses(mixture);
    v = mixture.code(coder, v, kCount, likely, reach);
  }
  return values;
}

size_t coded_size(const std::vector<uint32_t>& values) {
  IntervalEncoder coder;
  run(coder, values, 500, 2);
  return coder.finish().size();
}

}  // namespace

TEST_CASE("values come back wherever the search starts", "[guess_mixture]") {
  std::mt19937 random(3);
  std::vector<uint32_t> values = noisy_values(random, 600, 9);
  values.insert(values.end(), {0, kCount - 1, 1, kCount - 2});
  for (const uint32_t likely : {0u, 1u, 500u, kCount - 1}) {
    for (const uint64_t reach : {uint64_t{1}, uint64_t{7}, uint64_t{5000}, uint64_t{1} << 40}) {
      IntervalEncoder encoder;
      run(encoder, values, 0, 1);  // which do not matter to an encoder
      const std::vector<uint8_t> bytes = encoder.finish();
      IntervalDecoder decoder(bytes);
      CHECK(run(decoder, std::vector<uint32_t>(values.size()), likely, reach) == values);
      CHECK(!decoder.overrun());
    }
  }
}

TEST_CASE("a range of one value costs nothing", "[guess_mixture]") {
  IntervalEncoder coder;
  GuessMixture mixture(1, 64);
  mixture.add(0, 77, 256);
  CHECK(mixture.code(coder, 0, 1, 0, 1) == 0);
  CHECK(coder.finish().empty());
}

TEST_CASE("good guesses approach the entropy of their error", "[guess_mixture]") {
  std::mt19937 random(4);
  std::vector<uint32_t> values(8000);
  for (uint32_t& value : values) value = 500 + static_cast<uint32_t>(random() % 4);
  const double bits = 8.0 * static_cast<double>(coded_size(values)) / 8000;
  CHECK(bits < 2.0 * 1.03);  // log2(4) bits each
  CHECK(bits > 2.0);
}

TEST_CASE("no guess at all costs about the raw bits", "[guess_mixture]") {
  std::mt19937 random(5);
  IntervalEncoder coder;
  GuessMixture mixture(1, 64);
  for (int i = 0; i < 4000; ++i) {
    mixture.code(coder, static_cast<uint32_t>(random() % 1024), 1024, 0, 1);
  }
  const double bits = 8.0 * static_cast<double>(coder.finish().size()) / 4000;
  CHECK(bits == Approx(10).epsilon(0.01));
}

TEST_CASE("more guesses than are counted change nothing", "[guess_mixture]") {
  const auto code = [](size_t guesses) {
    IntervalEncoder coder;
    GuessMixture mixture(2, 64);
    for (uint32_t i = 0; i < 50; ++i) {
      mixture.clear();
      for (size_t k = 0; k < guesses; ++k)
        mixture.add(k < GuessMixture::kMaxGuesses ? 0 : 1, static_cast<int64_t>(k << 8), 256);
      mixture.code(coder, 7 * i, kCount, 0, 1);
    }
    return coder.finish();
  };
  CHECK(code(GuessMixture::kMaxGuesses) == code(100 * GuessMixture::kMaxGuesses));
}

TEST_CASE("weights of an error model rise with the error and stay whole", "[guess_mixture]") {
  std::mt19937 random(6);
  ErrorModel model;
  for (int round = 0; round < 3000; ++round) {
    const auto share = static_cast<uint32_t>(random() % (ErrorModel::kUnit + 1));
    model.observe(static_cast<int64_t>(random() % 4000) - 1500, share, 100);
  }
  int64_t last = model.reader().weight_to(-(int64_t{1} << 40));
  for (int64_t error = -5000; error <= 5000; ++error) {
    const int64_t weight = model.reader().weight_to(error);
    REQUIRE(weight >= last);
    last = weight;
  }
  CHECK(model.reader().weight_to(0) == 0);
  CHECK(model.reader().weight_to(int64_t{1} << 40) -
            model.reader().weight_to(-(int64_t{1} << 40)) <=
        (int64_t{1} << 40) + (int64_t{1} << 32));
}
