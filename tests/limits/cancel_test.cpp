// Every call of the decoder ends soon after it is cancelled, however far it is.
#include <pthread.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <thread>

#include "codec/common/fields/group_state.h"
#include "codec/dec/decoder.h"
#include "entropy/range_coder.h"
#include "entropy/rans.h"
#include "tests/codec/attributes/samples.h"
#include "tests/limits/built_file.h"

using namespace reeb;
using namespace reeb::test;

namespace {

// Processor time of the calling thread, which a busy machine does not stretch.
constexpr double kSoon = 0.05;
constexpr uint32_t kAround = kSlowness > 1 ? 80 : 400, kAcross = kSlowness > 1 ? 50 : 250;

using Call = std::function<Status(Decoder&)>;

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Calls on a thread of its own a decoder that has just been opened; where `after` is not negative,
/// cancels the call after so many seconds. Returns how long it took from then on.
double run(const Bytes& file, const Call& call, double after, Status& status) {
  std::unique_ptr<Decoder> decoder;
  REQUIRE(Decoder::open(file, {}, decoder).ok());
  std::atomic<bool> ended{false};
  double end = 0;
  std::atomic<double> start{-1};
  std::thread thread([&] {
    start = seconds(CLOCK_THREAD_CPUTIME_ID);
    status = call(*decoder);
    end = seconds(CLOCK_THREAD_CPUTIME_ID);
    ended = true;
    while (ended) std::this_thread::yield();  // its clock is still to be read
  });
  clockid_t clock{};
  pthread_getcpuclockid(thread.native_handle(), &clock);
  while (start < 0) std::this_thread::yield();
  double from = start;
  if (after >= 0) {
    while (!ended && seconds(clock) - start < after)
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    decoder->cancel();
    from = seconds(clock);  // not before: this thread may have to wait in between
  }
  while (!ended) std::this_thread::sleep_for(std::chrono::microseconds(200));
  ended = false;
  thread.join();
  return end - from;
}

void check_cancel(const Bytes& file, const char* name, const Call& call) {
  INFO(name);
  Status status;
  const double whole = run(file, call, -1, status);
  INFO(whole << " s if left alone");
  REQUIRE(status.ok());
  int cancelled = 0;
  for (const double share : {0.03, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9}) {
    const double more = run(file, call, share * whole, status);
    INFO("cancelled after " << share * whole << " s, ended " << more << " s later");
    CHECK((status.ok() || status.code() == StatusCode::kCancelled));
    CHECK(more <= kSoon * (kSlowness > 1 ? 3 : 1));
    cancelled += status.ok() ? 0 : 1;
  }
  if (whole > 2 * kSoon) CHECK(cancelled > 0);
}

Shape large() { return torus(kAround, kAcross); }

// Buffers are made before: a call that has not begun is not cancelled.
std::shared_ptr<std::vector<float>> buffer(size_t frames) {
  return std::make_shared<std::vector<float>>(frames * 3 * kAround * kAcross);
}

Call frame_with_normals() {
  return [xyz = buffer(1), normals = buffer(1)](Decoder& d) {
    return d.decode_frame(1, {.positions = xyz->data(), .normals = normals->data()});
  };
}

Call all_frames(uint32_t count) {
  return [count, xyz = buffer(count)](Decoder& d) {
    return d.decode_frames(0, count, xyz->data(), xyz->size() / count);
  };
}

/// Small residuals all over, so that weights are found anew.
Bytes code_ripple(Field& field, uint32_t components) {
  BinaryEncoder coder;
  for (uint32_t k = 0; k < components; ++k) {
    field.code_component([&](uint32_t row, float, uint32_t, MagnitudeModel::Bins& bins) {
      return field.model().code(coder, bins, static_cast<int64_t>((row * 7 + k) % 3) - 1);
    });
  }
  return coder.finish();
}

}  // namespace

TEST_CASE("what a shot takes is cancelled soon", "[cancel]") {
  for (const bool plain : {false, true}) {
    INFO((plain ? "plain" : "not plain"));
    const CodedMesh mesh = code_mesh(large(), plain, 12);
    GroupHeader h;
    if (plain) h.profile = Profile::kFast;
    const Bytes nothing = plain ? RansEncoder(0).finish() : Bytes{};
    const Bytes basis = plain ? RansEncoder(1).finish() : zero_basis(1, 0);
    const Bytes file = file_of(mesh, h, {.coefficients = nothing, .basis = basis});
    check_cancel(file, "connectivity", [](Decoder& d) {
      const Connectivity* out = nullptr;
      return d.connectivity(0, out);
    });
    check_cancel(file, "triangles", [](Decoder& d) {
      std::span<const uint32_t> out;
      return d.triangles(0, out);
    });
  }
}

TEST_CASE("frames of the main profile are cancelled soon", "[cancel]") {
  const CodedMesh mesh = code_mesh(large(), false, 12);
  GroupHeader h;
  h.frame_count = 40;
  h.component_count = 4;
  const GroupState state = start_closed_group(mesh.surface, mesh.surface.points(), false, 1);
  const Bytes coefficients = code_ripple(*state.coefficients, h.component_count);
  const Bytes basis = zero_basis(h.frame_count, h.component_count);
  const Bytes file = file_of(mesh, h, {.coefficients = coefficients, .basis = basis});
  check_cancel(file, "a frame and its normals", frame_with_normals());
  check_cancel(file, "all frames", all_frames(h.frame_count));
  check_cancel(file, "between frames", [xyz = buffer(1)](Decoder& d) {
    return d.decode_at(1.5, {.positions = xyz->data()});
  });
}

TEST_CASE("frames of the fast profile are cancelled soon", "[cancel]") {
  const CodedMesh mesh = code_mesh(large(), true, 12);
  GroupHeader h;
  h.frame_count = 10;
  h.profile = Profile::kFast;
  h.component_count = 24;
  const Bytes coefficients = RansEncoder(16).finish(), basis = RansEncoder(16).finish();
  const Bytes file = file_of(mesh, h, {.coefficients = coefficients, .basis = basis});
  check_cancel(file, "a frame and its normals", frame_with_normals());
  check_cancel(file, "all frames", all_frames(h.frame_count));
}

TEST_CASE("lossless frames are cancelled soon", "[cancel]") {
  const Shape shape = large();
  std::vector<std::vector<float>> frames;
  for (uint32_t t = 0; t < 4; ++t) {
    frames.push_back(shape.positions);
    for (size_t i = 0; i < frames[t].size(); ++i)
      frames[t][i] += static_cast<float>(t * (i % 5)) / 64;
  }
  const Bytes file = lossless_file(shape, frames, false);
  check_cancel(file, "a frame and its normals", frame_with_normals());
  check_cancel(file, "all frames", all_frames(4));
}

TEST_CASE("attributes are cancelled soon", "[cancel]") {
  const Shape shape = torus(kAround / 2, kAcross / 2);
  Sequence sequence = sequence_of({animate(shape, 2)});
  std::vector<float> corners, vertices;
  for (size_t c = 0; c < shape.connectivity.corners.size(); ++c) {
    corners.push_back(static_cast<float>(shape.connectivity.corners[c] % 97) / 97);
    corners.push_back(static_cast<float>(c % 5 / 4) / 8);
  }
  for (uint32_t t = 0; t < 2; ++t) {
    for (uint32_t v = 0; v < shape.connectivity.vertex_count; ++v)
      vertices.push_back(static_cast<float>((v * 31 + t * 7) % 64));
  }
  Shot& shot = sequence.shots[0];
  shot.attributes.push_back(make("uv", Domain::kCorner, ValueType::kBinary32, 2, corners));
  Attribute heat = make("heat", Domain::kVertex, ValueType::kBinary32, 1, vertices);
  heat.animated = true;
  shot.attributes.push_back(heat);
  EncodeOptions options = quick_options();
  options.target = Target::kLossless;
  options.effort = 1;
  const Bytes file = encode_or_fail(sequence, options).bytes;
  for (const uint32_t index : {0u, 1u}) {
    check_cancel(file, index == 0 ? "a static attribute" : "an animated one", [index](Decoder& d) {
      Attribute out;
      return d.decode_attribute(1, index, out);
    });
  }
  check_cancel(file, "a render mesh", [](Decoder& d) {
    std::unique_ptr<const RenderMesh> out;
    const uint32_t split[] = {0};
    return d.make_render_mesh(0, split, out);
  });
}
