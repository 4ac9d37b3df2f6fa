#include "codec/common/reference/face_order.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "codec/enc/reference/face_matching.h"
#include "entropy/interval_coder.h"
#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// The same faces in another order and from other first corners.
Connectivity shuffled(const Connectivity& faces, uint32_t seed) {
  std::mt19937 random(seed);
  FaceOrder order;
  order.index.resize(faces.face_sizes.size());
  std::iota(order.index.begin(), order.index.end(), 0u);
  std::shuffle(order.index.begin(), order.index.end(), random);
  for (const uint32_t size : faces.face_sizes)
    order.first.push_back(static_cast<uint32_t>(random() % size));
  return arrange_faces(FaceOrderContext(faces), order, faces.vertex_count);
}

std::vector<uint8_t> code(const Connectivity& faces, FaceOrder order) {
  IntervalEncoder coder;
  REQUIRE(code_face_order(coder, FaceOrderContext(faces), order).ok());
  return coder.finish();
}

}  // namespace

TEST_CASE("faces are put back into any order", "[face_order]") {
  for (const Shape& shape : small_shapes()) {
    INFO(shape.name);
    const Connectivity& input = shape.connectivity;
    for (const uint32_t seed : {1u, 2u}) {
      const Connectivity faces = shuffled(input, seed);
      CHECK((faces == input) == input.corners.empty());
      const std::vector<uint8_t> bytes = code(faces, match_faces(faces, input));
      IntervalDecoder decoder(bytes);
      FaceOrder decoded;
      const FaceOrderContext context(faces);
      REQUIRE(code_face_order(decoder, context, decoded).ok());
      CHECK(arrange_faces(context, decoded, input.vertex_count) == input);
    }
  }
}

TEST_CASE("a coherent order of faces costs little", "[face_order]") {
  // Faces as the shape makes them, row by row, against the same faces in a random order.
  const Connectivity rows = grid(40, 30).connectivity;
  const size_t random = code(rows, match_faces(rows, shuffled(rows, 3))).size();
  const size_t coherent = code(rows, match_faces(rows, rows)).size();
  const double faces = static_cast<double>(rows.face_sizes.size());
  CHECK(8 * static_cast<double>(coherent) < 1.5 * faces);
  CHECK(8 * static_cast<double>(random) > 9 * faces);  // log2(n!) / n is 8.8, of 4 corners 2 more
}

TEST_CASE("a cut order of faces is corrupt", "[face_order]") {
  const Connectivity rows = grid(20, 20).connectivity;
  const FaceOrder order = match_faces(rows, shuffled(rows, 4));
  const std::vector<uint8_t> bytes = code(rows, order);
  for (size_t size = 0; size + 8 < bytes.size(); size += 7) {
    IntervalDecoder decoder(std::span<const uint8_t>(bytes).first(size));
    FaceOrder decoded;
    CHECK(code_face_order(decoder, FaceOrderContext(rows), decoded).code() == StatusCode::kCorrupt);
  }
}
