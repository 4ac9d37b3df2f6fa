// Coder of the permutation from coding numbering to the order of the input.
//
// Real orders are coherent: neighbours on the surface have near indices, or indices that differ as
// those of their neighbours do. Each coded neighbour, and each parallelogram in index space, is a
// guess of the next index; errors are counted in indices still free.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/coding_tools.h"
#include "codec/common/mesh/triangle_topology.h"
#include "codec/common/reference/guess_mixture.h"
#include "codec/common/reference/mesh_state.h"

namespace reeb {

/// Indices not used yet, with ranks in logarithmic time.
class FreeIndices {
 public:
  explicit FreeIndices(uint32_t count);
  uint32_t count() const { return count_; }
  /// Number of free indices below `index`.
  uint32_t rank(uint32_t index) const;
  /// The free index with that rank, rank < count().
  uint32_t select(uint32_t rank) const;
  void take(uint32_t index);

 private:
  std::vector<uint32_t> tree_;  // Fenwick tree over free flags
  uint32_t count_;
};

/// Makes the guesses for each vertex from those before it, in the order of the topology.
class OrderPredictor {
 public:
  // Kinds of guesses; the last of each sort stands for all further ones.
  enum Kind : uint32_t {
    kPrevious = 0,
    kNeighbour = 1,
    kLastNeighbour = 5,
    kParallelogram = 6,
    kLastParallelogram = 8,
    kKindCount
  };
  static constexpr uint32_t kMemory = 512;    ///< observations, see GuessMixture
  static constexpr uint32_t kScale = 8 << 8;  ///< a step of the error models is one free index

  /// `topology`: of the triangles of coding vertices; must outlive the predictor.
  explicit OrderPredictor(const TriangleTopology& topology);
  void guess(uint32_t turn, const std::vector<uint32_t>& output_index, const FreeIndices& free,
             GuessMixture& out);
  /// The coding vertex whose turn it is.
  uint32_t vertex(uint32_t turn) const { return topology_.order[turn]; }
  /// Rank of the best guess after `guess`.
  uint32_t likely() const { return likely_; }

 private:
  void guess_neighbours(const std::vector<uint32_t>& output_index, const FreeIndices& free,
                        GuessMixture& out);

  const TriangleTopology& topology_;
  uint32_t likely_ = 0;
  std::vector<uint32_t> turn_of_;
  std::vector<uint32_t> neighbours_;  // turns of the coded ones
};

/// Codes `output_index` of every coding vertex, a permutation. `topology`: of the mesh's triangles.
template <class Coder>
Status code_vertex_order(Coder& coder, const TriangleTopology& topology,
                         std::vector<uint32_t>& output_index) {
  const uint32_t vertex_count = topology.point_count();
  FreeIndices free(vertex_count);
  OrderPredictor predictor(topology);
  GuessMixture guesses(OrderPredictor::kKindCount, OrderPredictor::kMemory);
  output_index.resize(vertex_count);
  for (uint32_t turn = 0; turn < vertex_count; ++turn) {
    uint32_t& index = output_index[predictor.vertex(turn)];
    if (uses(coding_tool::kOrderGuesses)) predictor.guess(turn, output_index, free, guesses);
    const uint32_t rank = guesses.code(coder, free.rank(index), free.count(),
                                       std::min(predictor.likely(), free.count() - 1), 1);
    if (ran_dry(coder)) return Status::corrupt("mesh: the vertex order is cut off");
    index = free.select(rank);
    free.take(index);
  }
  return {};
}

}  // namespace reeb
