// Coder of the permutation from coding numbering to the order of the input.
//
// Real orders are coherent: neighbours on the surface have near indices, or indices that differ as
// those of their neighbours do. Each coded neighbour (and each parallelogram in index space) is a
// guess of the next index; how far the truth lies from a guess of each kind is learned while
// coding. The guesses' distributions over the indices still free are added, and the index is found
// by halving.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/reference_syntax.h"

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

/// Learned distribution of the signed distance, in free indices, from one kind of guess to the
/// truth: constant within octave halves of the distance.
class DistanceModel {
 public:
  static constexpr uint32_t kUnit = 256;  ///< one observation

  DistanceModel();
  /// Weight below `rank` of a guess at `center` (ranks of free indices).
  uint64_t below(int64_t rank, int64_t center) const;
  /// Learns that the guess was there and explains `share` (0 .. kUnit) of the truth at `rank`.
  void observe(int64_t rank, int64_t center, uint32_t share);

 private:
  static constexpr uint32_t kBuckets = 64;
  void sum_up();

  std::array<std::array<uint32_t, kBuckets>, 2> weight_{};  // by side (above, below) and bucket
  std::array<std::array<uint64_t, kBuckets>, 2> inner_{};   // of the buckets nearer to the guess
  std::array<uint64_t, 2> total_{};
  uint64_t scale_ = 0;  // weight of the whole: how often guesses of this kind are right
  uint32_t seen_ = 0;
};

/// Guesses for one vertex and their sum as a distribution over the ranks of free indices.
class IndexGuesses {
 public:
  static constexpr uint32_t kKinds = 16;
  void clear() { guesses_.clear(); }
  void add(uint32_t kind, uint32_t center_rank) { guesses_.push_back({kind, center_rank}); }
  /// Weight of the ranks [first, last), at least last - first.
  uint64_t weight(uint32_t first, uint32_t last) const;
  void observe(uint32_t rank);

 private:
  struct Guess {
    uint32_t kind;
    int64_t center;
  };
  std::vector<Guess> guesses_;
  std::array<DistanceModel, kKinds> models_;
};

/// Makes the guesses for each coding vertex from those before it.
class OrderPredictor {
 public:
  /// `triangles`: three coding vertices each.
  OrderPredictor(uint32_t vertex_count, std::span<const uint32_t> triangles);
  void guess(uint32_t v, const std::vector<uint32_t>& output_index, const FreeIndices& free,
             IndexGuesses& out);

 private:
  // Kinds of guesses; the last of each sort stands for all further ones.
  enum Kind : uint32_t {
    kPrevious = 0,
    kNeighbour = 1,
    kLastNeighbour = 5,
    kParallelogram = 6,
    kLastParallelogram = 8,
    kKindCount
  };
  static_assert(kKindCount <= IndexGuesses::kKinds);

  void guess_neighbours(const std::vector<uint32_t>& output_index, const FreeIndices& free,
                        IndexGuesses& out);

  uint32_t vertex_count_;
  std::span<const uint32_t> triangles_;
  std::vector<uint32_t> twins_;
  std::vector<uint32_t> first_;       // of a vertex's half-edges in around_
  std::vector<uint32_t> around_;      // half-edges that start at each vertex
  std::vector<uint32_t> neighbours_;  // scratch
};

/// Codes `output_index` of every coding vertex, a permutation.
template <class Coder>
Status code_vertex_order(Coder& coder, uint32_t vertex_count, std::span<const uint32_t> triangles,
                         std::vector<uint32_t>& output_index) {
  FreeIndices free(vertex_count);
  OrderPredictor predictor(vertex_count, triangles);
  IndexGuesses guesses;
  for (uint32_t v = 0; v < vertex_count; ++v) {
    const uint32_t wanted = free.rank(slot(output_index, v));  // unused when decoding
    predictor.guess(v, output_index, free, guesses);
    uint32_t first = 0;
    uint32_t last = free.count();
    while (last - first > 1) {
      const uint32_t middle = first + (last - first) / 2;
      const uint64_t low = guesses.weight(first, middle);
      const uint64_t high = guesses.weight(middle, last);
      const bool up = coder.code(wanted >= middle, ratio_to_probability(high, low + high));
      (up ? first : last) = middle;
    }
    if (ran_dry(coder)) return Status::corrupt("mesh: the vertex order is cut off");
    guesses.observe(first);
    output_index[v] = free.select(first);
    free.take(output_index[v]);
  }
  return {};
}

}  // namespace reeb
