// The streams that ask for most, as far as they are known: none may ask for more work or memory
// than spec/levels.md says that its bytes can.
#include <algorithm>
#include <catch2/catch.hpp>
#include <ctime>

#include "codec/common/synthesis/correction_field.h"
#include "entropy/range_coder.h"
#include "tests/codec/allocation_meter.h"
#include "tests/codec/hostile.h"
#include "tests/limits/built_file.h"

using namespace reeb;
using namespace reeb::test;

namespace {

// Of spec/levels.md.
constexpr double kSecondsPerByte = 0.75e-3;
constexpr double kStart = 0.1;
constexpr double kMemoryPerByte = 256 << 10;

double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Decodes all there is, within the default limits, and holds time and memory to the bytes.
void check_work(const Bytes& file) {
  const double before = processor_time();
  const AllocationMeter meter;
  const Outcome out = probe(file, {});
  const double seconds = processor_time() - before;
  CHECK(out.opened.ok());
  CHECK(out.frames > 0);
  CHECK(out.refused == 0);
  const auto bytes = static_cast<double>(file.size());
  INFO(file.size() << " bytes, " << seconds << " s, " << meter.peak() << " bytes of memory");
  CHECK(seconds <= kSlowness * (kStart + kSecondsPerByte * bytes));
  CHECK(static_cast<double>(meter.peak()) <= (1 << 20) + kMemoryPerByte * bytes);
}

Shape empty_shape(const char* name) { return {.name = name, .connectivity = {}, .positions = {}}; }

/// Vertices without a face, all at one place.
Shape coincident(uint32_t count) {
  Shape s = empty_shape("coincident");
  for (uint32_t v = 0; v < count; ++v) s.add_vertex(0, 0, 0);
  return s;
}

/// The same beside a torus.
Shape unused(uint32_t count) {
  Shape s = torus(12, 8);
  s.name = "unused";
  for (uint32_t v = 0; v < count; ++v) s.add_vertex(0, 0, 0);
  return s;
}

/// Many strips, too short to hold up collapses by themselves, of which each loses its ends.
Shape doubled_strips(uint32_t count) {
  Shape s = empty_shape("doubled strips");
  for (uint32_t first = 0; first + 300 <= count; first += 300) {
    for (uint32_t v = 0; v < 300; ++v)
      s.add_vertex(static_cast<float>(v / 2), static_cast<float>(v % 2),
                   static_cast<float>(first) / 300);
    for (uint32_t v = first; v + 2 < first + 300; ++v) {
      s.add_face({v, v + 1, v + 2});
      s.add_face({v, v + 1, v + 2});
    }
  }
  return s;
}

/// One face of all vertices, and of one of them over and over.
Shape giant_faces(uint32_t count) {
  Shape s = empty_shape("giant faces");
  std::vector<uint32_t> all(count);
  for (uint32_t v = 0; v < count; ++v) all[v] = s.add_vertex(static_cast<float>(v), 0, 0);
  s.add_face(all);
  s.add_face(std::vector<uint32_t>(count, 0));
  return s;
}

constexpr uint32_t kMany = kSlowness > 1 ? 2000 : 10'000;

}  // namespace

TEST_CASE("no mesh asks for more than its bytes can", "[work]") {
  for (const Shape& shape : {coincident(kMany), unused(kMany), hub(kMany), fins(kMany / 8),
                             doubled_strip(kMany / 4), doubled_strips(kMany), giant_faces(kMany),
                             strip(kMany), grid(200, 100), points_only(kMany)}) {
    for (const bool plain : {false, true}) {
      INFO(shape.name << (plain ? ", plain" : ""));
      const CodedMesh mesh = code_mesh(shape, plain, 4);
      check_work(zero_file(mesh, plain ? Profile::kFast : Profile::kMain, 2, 1));
    }
  }
}

TEST_CASE("no planes ask for more than their bytes can", "[work]") {
  const CodedMesh point = code_mesh(single_vertex(), false, 4);
  const CodedMesh many = code_mesh(torus(80, 50), false, 12);
  for (const Profile profile : {Profile::kMain, Profile::kFast}) {
    INFO((profile == Profile::kMain ? "main" : "fast"));
    check_work(zero_file(point, profile, 2000, 60));
    check_work(zero_file(point, profile, 100, 300));
    check_work(zero_file(many, profile, 40, 100));
  }
}

TEST_CASE("no frames ask for more than their bytes can", "[work]") {
  const Shape shape = torus(80, 50);
  std::vector<std::vector<float>> frames(20, std::vector<float>(shape.positions.size(), 1.0f));
  for (size_t t = 0; t < frames.size(); ++t) frames[t][0] = static_cast<float>(t);
  for (const bool quick : {false, true}) check_work(lossless_file(shape, frames, quick));
}

TEST_CASE("no corrections ask for more than their bytes can", "[work]") {
  // A correction in every row costs as many bits that are 0 as there are coordinates in its frames.
  const CodedMesh mesh = code_mesh(torus(10, 6), false, 8);
  GroupHeader h;
  h.frame_count = 4000;
  h.flags = GroupHeader::kCorrected;
  h.correction_count = mesh.surface.rows();
  const Bytes basis = zero_basis(h.frame_count, 0);
  CorrectionField corrections(mesh.surface.graph, h.frame_count);
  BinaryEncoder coder;
  corrections.code(
      coder,
      [](uint32_t, uint32_t t, uint32_t axis) {
        return Correction{t == 0 && axis == 0 ? 1 : 0, false, 0};
      },
      [](auto...) { return true; });
  const Bytes section = coder.finish();
  check_work(file_of(mesh, h, {.basis = basis, .corrections = section}));
}
