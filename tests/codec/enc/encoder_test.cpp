#include "codec/enc/encoder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

void check_refused(const Sequence& sequence, const EncodeOptions& options,
                   StatusCode code = StatusCode::kInvalidArgument) {
  Bytes bytes(5, 1);
  EncodeStats stats;
  const Status status = encode(sequence, options, bytes, stats);
  CHECK(status.code() == code);
  CHECK_FALSE(status.message().empty());
  CHECK(bytes.empty());
}

Sequence small() { return sequence_of({animate(tetrahedron(), 3)}); }

}  // namespace

TEST_CASE("options out of range are refused", "[encoder]") {
  EncodeOptions options = quick_options();
  for (const Target target : {Target::kKg, Target::kMaxError, Target::kBpvf, Target::kSize}) {
    options.target = target;
    for (const double value : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      options.target_value = value;
      check_refused(small(), options);
    }
  }
  for (const Target target : {Target::kBpvf, Target::kSize}) {
    options.target = target;
    options.target_value = 0;
    check_refused(small(), options);
  }
  options = quick_options();
  options.group_length = 65537;
  check_refused(small(), options);
  options = quick_options();
  options.regions = 1025;
  check_refused(small(), options);
  options = quick_options();
  options.open_groups = 64;
  check_refused(small(), options);
  for (const Profile profile : {Profile::kFast, Profile::kThesis}) {
    options = quick_options();
    options.open_groups = 1;
    options.profile = profile;
    check_refused(small(), options);
  }
  for (const int effort : {-1, 0, 10}) {
    options = quick_options();
    options.effort = effort;
    check_refused(small(), options);
  }
}

TEST_CASE("empty and inconsistent sequences are refused", "[encoder]") {
  check_refused({}, quick_options());
  Sequence sequence = small();
  sequence.shots[0].frame_count = 0;
  check_refused(sequence, quick_options());
  sequence = small();
  sequence.shots[0].positions.pop_back();
  check_refused(sequence, quick_options());
  sequence = small();
  sequence.shots[0].connectivity.vertex_count = 0;
  check_refused(sequence, quick_options());
  sequence = small();
  sequence.shots[0].connectivity.corners[3] = 4;
  check_refused(sequence, quick_options());
  sequence = small();
  sequence.shots[0].connectivity.face_sizes.push_back(3);
  check_refused(sequence, quick_options());
}

TEST_CASE("positions that are no numbers are refused", "[encoder]") {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity(), 3e38f, -2e36f}) {
    for (const size_t at : {size_t{0}, size_t{17}, size_t{35}}) {
      Sequence sequence = small();
      sequence.shots[0].positions[at] = bad;
      check_refused(sequence, quick_options());
    }
  }
}

TEST_CASE("headers that cannot be written are refused", "[encoder]") {
  Sequence sequence = small();
  sequence.frame_rate = -1;
  check_refused(sequence, quick_options());
  sequence = small();
  sequence.start_time = std::nan("");
  check_refused(sequence, quick_options());
}

TEST_CASE("progress rises to the end", "[encoder]") {
  EncodeOptions options = quick_options();
  std::vector<double> seen;
  options.progress = [&](double done) {
    seen.push_back(done);
    return true;
  };
  encode_or_fail(small(), options);
  REQUIRE_FALSE(seen.empty());
  CHECK(std::is_sorted(seen.begin(), seen.end()));
  CHECK(seen.front() >= 0);
  CHECK(seen.back() <= 1);
}

TEST_CASE("an encoding can be cancelled at any call", "[encoder]") {
  int calls = 0;
  EncodeOptions options = quick_options();
  options.progress = [&](double) { return ++calls > 0; };
  encode_or_fail(small(), options);
  for (int last = 1; last <= calls; ++last) {
    int n = 0;
    options.progress = [&n, last](double) { return ++n < last; };
    check_refused(small(), options, StatusCode::kCancelled);
    CHECK(n == last);
  }
}

TEST_CASE("the same input gives the same bytes", "[encoder]") {
  EncodeOptions options = quick_options();
  options.regions = -1;
  const Sequence sequence = sequence_of({animate(torus(16, 11), 9)});
  CHECK(encode_or_fail(sequence, options).bytes == encode_or_fail(sequence, options).bytes);
}
