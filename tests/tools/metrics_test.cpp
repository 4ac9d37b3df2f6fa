#include "tools/metrics.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/test_meshes.h"

namespace reeb::tools {
namespace {

Sequence sequence_of(uint32_t vertices, uint32_t frames, std::vector<float> positions) {
  Sequence s;
  Shot& shot = s.shots.emplace_back();
  shot.connectivity.vertex_count = vertices;
  shot.frame_count = frames;
  shot.positions = std::move(positions);
  return s;
}

// Two vertices, two frames. Frame 1: (0,0,0), (2,0,0), mean (1,0,0), spread 1 + 1 = 2.
// Frame 2: (0,0,0), (0,4,0), mean (0,2,0), spread 4 + 4 = 8.
Sequence original() { return sequence_of(2, 2, {0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 4, 0}); }

// Displacements: frame 1 none and (0.3, 0, 0.4), length 0.5; frame 2 (0, 0, -1) and none.
Sequence moved() { return sequence_of(2, 2, {0, 0, 0, 2.3f, 0, 0.4f, 0, 0, -1, 0, 4, 0}); }

}  // namespace

TEST_CASE("figures by hand") {
  Comparison c;
  REQUIRE(compare_sequences(original(), moved(), c).ok());
  // Squared errors 0.25 and 1, spreads 2 and 8.
  CHECK(c.frames[0].kg == Approx(100 * std::sqrt(0.25 / 2)));
  CHECK(c.frames[1].kg == Approx(100 * std::sqrt(1.0 / 8)));
  CHECK(c.overall.kg == Approx(100 * std::sqrt(1.25 / 10)));
  CHECK(c.frames[0].rmse == Approx(std::sqrt(0.25 / 2)));
  CHECK(c.frames[1].rmse == Approx(std::sqrt(1.0 / 2)));
  CHECK(c.overall.rmse == Approx(std::sqrt(1.25 / 4)));
  CHECK(c.frames[0].max_error == Approx(0.4));
  CHECK(c.overall.max_error == Approx(1));
  CHECK(c.max_frame == 1);
  CHECK(c.max_vertex == 0);
  // The box of all frames is 2 x 4 x 0.
  CHECK(c.diagonal == Approx(std::sqrt(20.0)));
  CHECK(c.relative_max_error() == Approx(1 / std::sqrt(20.0)));
  CHECK_FALSE(c.identical);
}

TEST_CASE("the KG error is against the mean of each frame, so a path does not hide it") {
  Sequence far_away = original();
  Sequence far_moved = moved();
  for (size_t i = 6; i < 12; ++i) {
    far_away.shots[0].positions[i] += 1024;
    far_moved.shots[0].positions[i] += 1024;
  }
  Comparison c;
  REQUIRE(compare_sequences(far_away, far_moved, c).ok());
  CHECK(c.overall.kg == Approx(100 * std::sqrt(1.25 / 10)).epsilon(1e-3));
}

TEST_CASE("identical sequences, and a single point") {
  Comparison c;
  REQUIRE(compare_sequences(original(), original(), c).ok());
  CHECK(c.identical);
  CHECK(c.overall.kg == 0);
  CHECK(c.overall.max_error == 0);
  CHECK(c.relative_max_error() == 0);

  REQUIRE(compare_sequences(sequence_of(1, 1, {1, 2, 3}), sequence_of(1, 1, {1, 2, 3}), c).ok());
  CHECK(c.overall.kg == 0);
  REQUIRE(compare_sequences(sequence_of(1, 1, {1, 2, 3}), sequence_of(1, 1, {1, 2, 4}), c).ok());
  CHECK(std::isinf(c.overall.kg));
  CHECK(c.overall.rmse == 1);
  // -0 and 0 are equal but not identical.
  REQUIRE(
      compare_sequences(sequence_of(1, 1, {0, 0, 0}), sequence_of(1, 1, {0, -0.0f, 0}), c).ok());
  CHECK(c.overall.max_error == 0);
  CHECK_FALSE(c.identical);
}

TEST_CASE("remainders are part of the positions") {
  // As in the original, but for a quarter that the numbers cannot hold.
  const Remainders quarter{{0, 0, 0, 0.25f, 0, 0, 0, 0, 0, 0, 0, 0}};
  Comparison c;
  REQUIRE(compare_sequences(original(), original(), c, quarter).ok());
  CHECK_FALSE(c.identical);
  CHECK(c.overall.max_error == 0.25);
  CHECK(c.overall.rmse == Approx(std::sqrt(0.0625 / 4)));
  // Frame 1: (0,0,0), (2.25,0,0), spread 2 * 1.125^2; frame 2 has 8.
  CHECK(c.overall.kg == Approx(100 * std::sqrt(0.0625 / (2 * 1.125 * 1.125 + 8))));
  REQUIRE(compare_sequences(original(), original(), c, {}, quarter).ok());
  CHECK(c.overall.max_error == 0.25);
  REQUIRE(compare_sequences(original(), original(), c, quarter, quarter).ok());
  CHECK(c.identical);
  CHECK(c.overall.max_error == 0);
}

TEST_CASE("shots may be cut differently") {
  Sequence cut = moved();
  Shot second = cut.shots[0];
  second.frame_count = 1;
  second.positions.erase(second.positions.begin(), second.positions.begin() + 6);
  cut.shots[0].frame_count = 1;
  cut.shots[0].positions.resize(6);
  cut.shots.push_back(second);
  Comparison c;
  REQUIRE(compare_sequences(original(), cut, c).ok());
  CHECK(c.overall.kg == Approx(100 * std::sqrt(1.25 / 10)));
  CHECK(vertex_frames(cut) == 4);
}

TEST_CASE("what cannot be compared is told, with the frame") {
  Comparison c;
  const auto message = [&](const Sequence& a, const Sequence& b) {
    const Status status = compare_sequences(a, b, c);
    REQUIRE_FALSE(status.ok());
    return status.message();
  };
  CHECK_THAT(message(original(), sequence_of(2, 1, std::vector<float>(6))),
             Catch::Contains("2 against 1 frame"));
  CHECK_THAT(message(original(), sequence_of(3, 2, std::vector<float>(18))),
             Catch::Contains("frame 1: 2 against 3 vertices"));
  Sequence with_face = original();
  with_face.shots[0].connectivity.face_sizes = {3};
  with_face.shots[0].connectivity.corners = {0, 1, 1};
  CHECK_THAT(message(original(), with_face), Catch::Contains("0 against 1 face"));
  Sequence other_face = with_face;
  other_face.shots[0].connectivity.corners = {0, 0, 1};
  CHECK_THAT(message(with_face, other_face), Catch::Contains("faces differ"));
}

TEST_CASE("the order of faces and their first corners do not matter, their sense does") {
  const TestMesh mesh = test_mesh("a", square(), {{0, 1, 2}, {0, 2, 3}});
  const TestMesh shuffled = test_mesh("b", square(), {{2, 3, 0}, {1, 2, 0}});
  const TestMesh reversed = test_mesh("c", square(), {{2, 1, 0}, {0, 2, 3}});
  const auto sequence = [](const TestMesh& m) {
    Sequence s;
    s.shots.push_back({m.connectivity, 1, m.positions, {}});
    return s;
  };
  Comparison c;
  REQUIRE(compare_sequences(sequence(mesh), sequence(shuffled), c).ok());
  CHECK(c.identical);
  CHECK_FALSE(compare_sequences(sequence(mesh), sequence(reversed), c).ok());
}

}  // namespace reeb::tools
