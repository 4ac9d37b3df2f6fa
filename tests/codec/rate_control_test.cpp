#include <catch2/catch.hpp>

#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

EncodeOptions aim(Target target, double value) {
  EncodeOptions options = quick_options();
  options.target = target;
  options.target_value = value;
  return options;
}

/// Not above the target, and within 1 % of it.
void check_met(double measured, double wanted) {
  CHECK(measured <= wanted);
  CHECK(measured >= 0.99 * wanted);
}

}  // namespace

TEST_CASE("a KG error is met within one per cent", "[rate_control]") {
  const Sequence sequence = large_sequence();
  for (const double kg : {0.02, 0.3}) {
    const Encoded out = encode_or_fail(sequence, aim(Target::kKg, kg));
    check_met(measure(sequence, decode_or_fail(out.bytes)).kg, kg);
  }
}

TEST_CASE("bits per vertex and frame are met within one per cent", "[rate_control]") {
  const Sequence sequence = large_sequence();
  const Encoded out = encode_or_fail(sequence, aim(Target::kBpvf, 1.0));
  check_met(8.0 * static_cast<double>(out.bytes.size()) / vertex_frames(sequence), 1.0);
}

TEST_CASE("a size is met within one per cent", "[rate_control]") {
  const Sequence sequence = large_sequence();
  const Encoded out = encode_or_fail(sequence, aim(Target::kSize, 9000));
  check_met(static_cast<double>(out.bytes.size()), 9000);
}

TEST_CASE("targets take few trials", "[rate_control]") {
  const Sequence sequence = large_sequence();
  int trials = 0;
  for (const auto& [target, value] :
       {std::pair(Target::kKg, 0.5), std::pair(Target::kKg, 0.01), std::pair(Target::kBpvf, 0.8),
        std::pair(Target::kBpvf, 6.0), std::pair(Target::kSize, 20000.0)}) {
    EncodeOptions options = aim(target, value);
    options.progress = [&](double) { return ++trials > 0; };
    encode_or_fail(sequence, options);
  }
  CHECK(trials <= 5 * 7);
}

TEST_CASE("the fast profile meets its target too", "[rate_control]") {
  const Sequence sequence = large_sequence();
  EncodeOptions options = aim(Target::kKg, 0.1);
  options.profile = Profile::kFast;
  const Encoded fast = encode_or_fail(sequence, options);
  check_met(measure(sequence, decode_or_fail(fast.bytes)).kg, 0.1);
  options.profile = Profile::kMain;
  CHECK(encode_or_fail(sequence, options).bytes.size() < fast.bytes.size());
}

TEST_CASE("every effort meets its target, and more effort takes no more bytes", "[rate_control]") {
  const Sequence sequence = sequence_of({animate(torus(24, 15), 20)});
  size_t before = SIZE_MAX;
  for (const int effort : {kMinEffort, kDefaultEffort, kMaxEffort}) {
    EncodeOptions options = aim(Target::kKg, 0.1);
    options.effort = effort;
    options.regions = -1;
    const Encoded out = encode_or_fail(sequence, options);
    check_met(measure(sequence, decode_or_fail(out.bytes)).kg, 0.1);
    CHECK(static_cast<double>(out.bytes.size()) < 1.01 * static_cast<double>(before));
    before = out.bytes.size();
  }
}

TEST_CASE("groups of any kind meet a size", "[rate_control]") {
  for (const uint32_t open_groups : {0u, 3u}) {
    EncodeOptions options = aim(Target::kSize, 9000);
    options.group_length = 10;
    options.open_groups = open_groups;
    check_met(static_cast<double>(encode_or_fail(large_sequence(), options).bytes.size()), 9000);
  }
}

TEST_CASE("less error takes more bytes", "[rate_control]") {
  const Sequence sequence = sequence_of({animate(torus(16, 11), 12)});
  size_t before = 0;
  for (const double kg : {2.0, 0.5, 0.1, 0.02, 0.004}) {
    const Encoded out = encode_or_fail(sequence, aim(Target::kKg, kg));
    CHECK(out.bytes.size() > before);
    CHECK(measure(sequence, decode_or_fail(out.bytes)).kg <= kg);
    before = out.bytes.size();
  }
}

TEST_CASE("targets that nothing meets are refused with the nearest figures", "[rate_control]") {
  const Sequence sequence = sequence_of({animate(torus(16, 11), 5)});
  for (const auto& [target, value] : {std::pair(Target::kSize, 20.0), {Target::kBpvf, 1e-4}}) {
    Bytes bytes(3, 7);
    EncodeStats stats;
    const Status status = encode(sequence, aim(target, value), bytes, stats);
    CHECK(status.code() == StatusCode::kInvalidArgument);
    CHECK(status.message().find("out of reach") != std::string::npos);
    CHECK(bytes.empty());
  }
}

TEST_CASE("targets near the precision of the input are met", "[rate_control]") {
  // Rounding to binary32 alone is an error of some 3e-6 %.
  const Sequence sequence = sequence_of({animate(torus(16, 11), 20)});
  for (const double kg : {1e-3, 1e-4, 5e-5, 2e-5, 1e-5, 1e-6, 1e-7}) {
    INFO(kg);
    const Encoded out = encode_or_fail(sequence, aim(Target::kKg, kg));
    CHECK(measure(sequence, decode_or_fail(out.bytes)).kg <= kg);
  }
}
