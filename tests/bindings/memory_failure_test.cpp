// Every allocation of a decoder's life fails once: nothing leaks, crashes or hangs, and what is
// reported is the lack of memory.
#include <reeb.h>

#include <catch2/catch.hpp>
#include <functional>

#include "tests/bindings/failing_new.h"
#include "tests/bindings/streams.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Few vertices, so that there are not too many allocations to try.
const Bytes& least_stream() {
  static const Bytes bytes = [] {
    EncodeOptions options = quick_options();
    options.target_value = 3;
    options.group_length = 3;
    return encode_or_fail(sequence_of({animate(torus(4, 3), 4), animate(tetrahedron(), 1)}),
                          options)
        .bytes;
  }();
  return bytes;
}

int read_least(void*, uint64_t offset, void* buffer, size_t size) {
  std::copy_n(least_stream().begin() + static_cast<long>(offset), size,
              static_cast<uint8_t*>(buffer));
  return 0;
}

/// Two frames, one of them between two others with normals.
reeb_result play(reeb_decoder* d) {
  float xyz[12 * 3], normals[12 * 3];
  reeb_target target = {};
  target.struct_size = sizeof target;
  target.positions = xyz;
  target.vertex_capacity = 12;
  reeb_result result = reeb_get_frame(d, 4, &target);
  if (result != REEB_OK) return result;
  target.normals = normals;
  return reeb_get_between(d, 2.5, &target);
}

/// Opens in one of three ways and plays.
reeb_result live(int way, const reeb_options& options) {
  const Bytes& bytes = least_stream();
  const reeb_reader reader = {bytes.size(), read_least, nullptr};
  reeb_decoder* d = nullptr;
  reeb_result result = way == 0   ? reeb_open_memory(bytes.data(), bytes.size(), &options, &d)
                       : way == 1 ? reeb_open_reader(&reader, &options, &d)
                                  : reeb_open_push(&options, &d);
  if (result == REEB_OK && way == 2) result = reeb_push(d, bytes.data(), bytes.size());
  if (result == REEB_OK) result = play(d);
  if (result == REEB_OUT_OF_MEMORY && d != nullptr) {
    // The handle is still good for those calls that need no more than there is.
    stop_failing();
    if (way != 2) result = play(d) == REEB_OK ? REEB_OUT_OF_MEMORY : REEB_CORRUPT;
  }
  reeb_close(d);
  return result;
}

}  // namespace

TEST_CASE("every allocation may fail", "[memory]") {
  least_stream();
  reeb_options options = {};
  options.struct_size = sizeof options;
  for (const uint32_t threads : {1u, 2u}) {
    options.threads = threads;
    for (int way = 0; way < 3; ++way) {
      REQUIRE(live(way, options) == REEB_OK);
      const int64_t before = blocks_held();
      int64_t failures = 0;
      // Threads make the count vary a little: each number up to a good way past the last failure.
      const int64_t stride = threads > 1 ? 7 : 1;  // most of it is the same with threads
      for (int64_t n = 1, unharmed = 0; unharmed < 3; n += stride) {
        fail_after(n);
        const reeb_result result = live(way, options);
        stop_failing();
        const bool failed = has_failed();
        unharmed = failed ? 0 : unharmed + 1;
        failures += failed;
        if (result != REEB_OK && result != REEB_OUT_OF_MEMORY)
          FAIL("allocation " << n << ": " << result);
        if (!failed && result != REEB_OK) FAIL("allocation " << n << " did not fail");
        if (blocks_held() != before)
          FAIL("allocation " << n << ": " << blocks_held() - before << " blocks leak");
      }
      CHECK(failures > 100);
    }
  }
}
