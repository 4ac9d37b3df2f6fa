// Every allocation of a decoder's life fails once: nothing leaks, crashes or hangs, and what is
// reported is the lack of memory.
#include <reeb.h>
#include <reeb_attributes.h>

#include <catch2/catch.hpp>
#include <functional>

#include "tests/bindings/attribute_streams.h"
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

/// A file, how it is read and what is done with it.
struct Life {
  const Bytes& bytes;
  reeb_result (*play)(reeb_decoder*);
};

int read_bytes(void* user, uint64_t offset, void* buffer, size_t size) {
  std::copy_n(static_cast<const Bytes*>(user)->begin() + static_cast<long>(offset), size,
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

/// Animated and computed values in the layout of a render mesh.
reeb_result show(reeb_decoder* d, const reeb_render_mesh* mesh) {
  float numbers[24 * 3], normals[24 * 3];
  reeb_target target = {};
  target.struct_size = sizeof target;
  target.positions = numbers;
  target.normals = normals;
  target.vertex_capacity = 24;
  reeb_result result = reeb_get_render_between(d, 0.5, mesh, &target);
  const reeb_value_target values = {sizeof values, numbers, 0, 24};
  for (const uint32_t index : {0u, 2u, 3u}) {
    if (result == REEB_OK) result = reeb_get_render_values(d, 1, index, mesh, &values);
  }
  return result;
}

reeb_result use_attributes(reeb_decoder* d) {
  const uint32_t split_by[] = {0, 3};
  reeb_render_mesh* mesh = nullptr;
  reeb_result result = reeb_make_render_mesh(d, 0, split_by, 2, &mesh);
  if (result == REEB_OK) result = show(d, mesh);
  reeb_free_render_mesh(mesh);
  char text[8];
  if (result == REEB_OK) result = reeb_get_name(d, 0, 1, 1, text, sizeof text, nullptr);
  if (result == REEB_OK) result = reeb_get_resource_bytes(d, 0, text, sizeof text, nullptr);
  float xyz[2 * 48];
  return result == REEB_OK ? reeb_get_frames(d, 0, 2, xyz, 48) : result;
}

/// Opens in one of three ways and plays.
reeb_result live(const Life& life, int way, const reeb_options& options) {
  const Bytes& bytes = life.bytes;
  const reeb_reader reader = {bytes.size(), read_bytes, const_cast<Bytes*>(&bytes)};
  reeb_decoder* d = nullptr;
  reeb_result result = way == 0   ? reeb_open_memory(bytes.data(), bytes.size(), &options, &d)
                       : way == 1 ? reeb_open_reader(&reader, &options, &d)
                                  : reeb_open_push(&options, &d);
  if (result == REEB_OK && way == 2) result = reeb_push(d, bytes.data(), bytes.size());
  if (result == REEB_OK) result = life.play(d);
  if (result == REEB_OUT_OF_MEMORY && d != nullptr) {
    // The handle is still good for those calls that need no more than there is.
    stop_failing();
    if (way != 2) result = life.play(d) == REEB_OK ? REEB_OUT_OF_MEMORY : REEB_CORRUPT;
  }
  reeb_close(d);
  return result;
}

/// Fails every allocation, or with threads, which make their number vary a little, most of them: up
/// to a good way past the last failure. Returns how many failed.
int64_t fail_each(const Life& life, int way, const reeb_options& options) {
  REQUIRE(live(life, way, options) == REEB_OK);
  const int64_t before = blocks_held();
  const int64_t stride = options.threads > 1 ? 7 : 1;
  int64_t failures = 0;
  for (int64_t n = 1, unharmed = 0; unharmed < 3; n += stride) {
    fail_after(n);
    const reeb_result result = live(life, way, options);
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
  return failures;
}

}  // namespace

TEST_CASE("every allocation may fail", "[memory]") {
  auto options = reeb_options();
  options.struct_size = sizeof options;
  for (const uint32_t threads : {1u, 2u}) {
    options.threads = threads;
    for (int way = 0; way < 3; ++way) CHECK(fail_each({least_stream(), play}, way, options) > 100);
  }
}

TEST_CASE("every allocation for attributes may fail", "[memory]") {
  auto options = reeb_options();
  options.struct_size = sizeof options;
  for (int way = 0; way < 3; ++way)
    CHECK(fail_each({attribute_stream(), use_attributes}, way, options) > 200);
}
