// Streams are coded alike whatever the host has done to floating point, which it finds as it was.
#include "codec/common/base/float_state.h"

#include <catch2/catch.hpp>
#include <cfenv>
#include <thread>

#include "codec/common/base/parallel.h"
#include "codec/dec/decoder.h"
#include "codec/enc/encoder.h"
#include "conformance/host_floats.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Keeps the compiler from computing with its own rounding.
volatile float one = 1, tiny = 0x1p-30f, subnormal = 0x1p-140f;

/// 1 + a little, 1 - a little, a subnormal: what they come to tells every state from the standard.
struct Arithmetic {
  float above = one + tiny;
  float below = one - tiny;
  float flushed = subnormal * one;
  bool operator==(const Arithmetic&) const = default;
};

/// Sets a state for its life.
struct Host {
  explicit Host(const char* floats) { REQUIRE(set_host_floats(floats)); }
  ~Host() { std::fesetenv(FE_DFL_ENV); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
};

constexpr const char* kStates[] = {"up", "down", "zero", "flush"};

}  // namespace

TEST_CASE("a state is the standard one within its life, and the host's after it", "[float_state]") {
  const Arithmetic standard;
  for (const char* floats : kStates) {
    Arithmetic before, within, nested, after;
    {
      const Host host(floats);
      before = Arithmetic();
      {
        const FloatState state;
        within = Arithmetic();
        const FloatState again;
        nested = Arithmetic();
      }
      after = Arithmetic();
    }
    INFO(floats);
    CHECK(within == standard);
    CHECK(nested == standard);
    CHECK(after == before);
    CHECK(Arithmetic() == standard);
#if defined(__SSE2__) || defined(__aarch64__)
    CHECK_FALSE(before == standard);
#endif
  }
}

TEST_CASE("threads of the library compute in the standard state", "[float_state]") {
  const Arithmetic standard;
  std::vector<Arithmetic> found(4);
  {
    const Host host("up");
    parallel_ranges(4, 4, [&](uint32_t begin, uint32_t) { found[begin] = Arithmetic(); });
  }
  for (const Arithmetic& f : found) CHECK(f == standard);
}

TEST_CASE("the host's floating point changes no byte and no bit", "[float_state]") {
  const Sequence sequence = sequence_of({animate(torus(16, 12), 9)});
  std::vector<EncodeOptions> all(4);
  all[0].regions = 3;
  all[1].profile = Profile::kFast;
  all[2].profile = Profile::kThesis;
  all[3].target = Target::kLossless;
  for (EncodeOptions& options : all) {
    options.effort = 1;
    options.threads = 2;
    const auto encoded = [&] {
      std::vector<uint8_t> bytes;
      EncodeStats stats;
      const Status status = encode(sequence, options, bytes, stats);
      return status.ok() ? bytes : std::vector<uint8_t>();
    };
    const auto decoded = [](const std::vector<uint8_t>& bytes) {
      Sequence out;
      DecodeOptions two;
      two.threads = 2;
      return decode_sequence(bytes, two, out).ok() ? out.shots[0].positions : std::vector<float>();
    };
    const std::vector<uint8_t> bytes = encoded();
    const std::vector<float> positions = decoded(bytes);
    REQUIRE(!positions.empty());
    for (const char* floats : kStates) {
      std::vector<uint8_t> other;
      std::vector<float> other_positions, refused;
      Arithmetic before, after;
      {
        const Host host(floats);
        before = Arithmetic();
        other = encoded();
        other_positions = decoded(bytes);
        refused = decoded({});  // an early return
        after = Arithmetic();
      }
      INFO(floats);
      CHECK(other == bytes);
      CHECK(other_positions == positions);
      CHECK(refused.empty());
      CHECK(after == before);
    }
  }
}
