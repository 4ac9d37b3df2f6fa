// Coder of the faces' order and first corners, for streams that keep them.
//
// The decoder has the faces already, in an order and from corners on that the coding of the mesh
// gives. Where each goes in the input's order is coded as the order of vertices is, on the graph of
// faces that share an edge; then, in the input's order, which corner comes first.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "codec/common/reference/guess_mixture.h"
#include "codec/common/reference/mesh_state.h"
#include "codec/common/reference/vertex_order.h"
#include "entropy/adaptive_bit.h"

namespace reeb {

/// What both directions know before anything is coded.
class FaceOrderContext {
 public:
  /// `faces`: in the decoder's order, corners in output numbering; must outlive the context.
  explicit FaceOrderContext(const Connectivity& faces);

  uint32_t count() const { return static_cast<uint32_t>(faces_.face_sizes.size()); }
  std::span<const uint32_t> corners(uint32_t face) const {
    return std::span(faces_.corners).subspan(first_[face], faces_.face_sizes[face]);
  }
  /// Triangles of faces that share edges with their first corner, for OrderPredictor.
  std::vector<uint32_t> dual_triangles() const;
  /// Index that a face has where faces are in the order of their lowest vertices.
  uint32_t index_by_vertex(uint32_t face) const;

 private:
  /// The other face at the edge that starts at each corner; the face itself where there is not
  /// exactly one.
  std::vector<uint32_t> faces_across() const;

  const Connectivity& faces_;
  std::vector<size_t> first_;  ///< corner of each face
};

/// First corners: among a face's corners from its lowest vertex on, each in turn may be the first.
class FirstCornerSyntax {
 public:
  /// `corners`: of the face, in the decoder's rotation; returns the place of the first one.
  template <class Coder>
  uint32_t code(Coder& coder, std::span<const uint32_t> corners, uint32_t first) {
    const auto size = static_cast<uint32_t>(corners.size());
    const auto lowest =
        static_cast<uint32_t>(std::min_element(corners.begin(), corners.end()) - corners.begin());
    uint32_t passed = 0;
    uint32_t at = lowest;
    for (; passed + 1 < size; ++passed, at = at + 1 < size ? at + 1 : 0) {
      AdaptiveBit& model = models_[std::min(passed, kPlaces - 1)][place_before(corners[at])][last_];
      if (model.code(coder, at == first)) break;
    }
    last_ = std::min(passed, kPlaces - 1);
    before_.clear();
    for (uint32_t i = 0; i < std::min(size, kPlaces); ++i)
      before_.push_back(corners[(at + i) % size]);
    return at;
  }

 private:
  static constexpr uint32_t kPlaces = 4;
  /// Where the face before has a vertex; kPlaces where it has not.
  uint32_t place_before(uint32_t vertex) const {
    const auto at = std::find(before_.begin(), before_.end(), vertex);
    return at == before_.end() ? kPlaces : static_cast<uint32_t>(at - before_.begin());
  }

  AdaptiveBit models_[kPlaces][kPlaces + 1][kPlaces];
  std::vector<uint32_t> before_;  ///< first corners of the face before
  uint32_t last_ = 0;             ///< corners passed in it
};

/// Place of every face in the input's order, and of its first corner among its corners.
struct FaceOrder {
  std::vector<uint32_t> index;
  std::vector<uint32_t> first;
};

/// Codes the order: complete with encoders, filled in with decoders.
template <class Coder>
Status code_face_order(Coder& coder, const FaceOrderContext& context, FaceOrder& order) {
  const uint32_t count = context.count();
  order.index.resize(count);
  order.first.resize(count);
  FreeIndices free(count);
  const std::vector<uint32_t> dual = context.dual_triangles();
  const TriangleTopology topology(count, dual);
  OrderPredictor predictor(topology);
  GuessMixture guesses(OrderPredictor::kKindCount + 1, OrderPredictor::kMemory);
  std::vector<uint32_t> face_at(count);
  for (uint32_t turn = 0; turn < count; ++turn) {
    const uint32_t face = predictor.vertex(turn);
    predictor.guess(turn, order.index, free, guesses);
    guesses.add(OrderPredictor::kKindCount, int64_t{free.rank(context.index_by_vertex(face))} << 8,
                OrderPredictor::kScale);
    const uint32_t rank = guesses.code(coder, free.rank(order.index[face]), free.count(),
                                       std::min(predictor.likely(), free.count() - 1), 1);
    if (ran_dry(coder)) return Status::corrupt("mesh: the order of faces is cut off");
    order.index[face] = free.select(rank);
    free.take(order.index[face]);
    face_at[order.index[face]] = face;
  }
  FirstCornerSyntax first_corners;
  for (const uint32_t face : face_at) {
    order.first[face] = first_corners.code(coder, context.corners(face), order.first[face]);
    if (ran_dry(coder)) return Status::corrupt("mesh: the first corners are cut off");
  }
  return {};
}

/// The faces in their order, each from its first corner on.
Connectivity arrange_faces(const FaceOrderContext& context, const FaceOrder& order,
                           uint32_t vertex_count);

}  // namespace reeb
