// Output indices of a plain reference mesh (fast profile), along its walk: which of a few guesses
// is right, else by how many free indices the best one is missed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/common/mesh/mesh_walk.h"
#include "codec/common/reference/mesh_state.h"
#include "codec/common/reference/vertex_order.h"
#include "entropy/rans.h"

namespace reeb {

/// Guesses the index of one vertex after another: where the parallelograms of its known triangles
/// lead among indices, behind the index of the vertex before, next to those of its neighbours.
/// Kinds of guesses that missed by little lately come first.
class IndexGuesser {
 public:
  static constexpr uint32_t kNone = 1;  ///< the symbol of an index that is no guess

  explicit IndexGuesser(const MeshWalk& walk);

  /// Collects the guesses for the vertex of a turn, which are free indices.
  void start(uint32_t turn);
  bool empty() const { return first_ == kKinds; }
  /// Class of the symbol, where there is a guess.
  uint32_t symbol_class() const;
  /// 0 for the first guess, kNone, or 1 more than the place among the guesses.
  uint32_t symbol_of(uint32_t index) const;
  /// The guess of a symbol that is not kNone; false where there is none.
  bool find(uint32_t symbol, uint32_t& index) const;
  /// The first guess; without any, what follows the index before.
  uint32_t likely() const;
  /// Class of the difference between the ranks of the index and of `likely`, among free indices.
  uint32_t difference_class() const;
  /// Takes the index.
  void note(uint32_t index);

 private:
  // One guess of every kind: 0 and 1 parallelograms, 2 behind the vertex before, 4 .. 7 behind the
  // neighbours, 8 .. 11 before them.
  static constexpr uint32_t kTips = 2;        ///< parallelograms that are followed
  static constexpr uint32_t kNeighbours = 4;  ///< that are looked at, those of the latest turns
  static constexpr uint32_t kKinds = 12;
  static constexpr int32_t kLast = INT32_MAX;

  using Whole = int32_t __attribute__((vector_size(16)));
  using Wholes = std::array<Whole, 3>;  ///< of all kinds

  static int32_t at(const Wholes& of, uint32_t kind) { return of[kind / 4][kind % 4]; }
  /// Keeps the turns descending, each once.
  static void insert(int32_t turn, int32_t (&latest)[kNeighbours]);
  /// Takes the guesses of kinds 4 * part + 0 .. 3, some of which may be no free index.
  void order_guesses(uint32_t part, const Whole& guesses);
  /// The kind that comes first; kKinds where there is none.
  static uint32_t first_of(const Wholes& order);

  const MeshWalk& walk_;
  std::vector<uint8_t> taken_;  ///< every index, and one that is none
  std::vector<int32_t> index_;  ///< of every turn
  Wholes guess_;
  Wholes order_;        ///< the lowest comes first; kLast for what is no guess
  Wholes cost_;         ///< decaying mean of the log2 of what a kind missed by, in 1/512
  uint32_t first_ = 0;  ///< its kind
  uint32_t turn_ = 0;
};

/// Codes the symbol that tells which guess is right.
template <class Coder>
uint32_t code_symbol(Coder& coder, const IndexGuesser& guesser, uint32_t index) {
  if (guesser.empty()) return IndexGuesser::kNone;
  uint32_t symbol = 0;
  if constexpr (!kDecodes<Coder>) symbol = guesser.symbol_of(index);
  return rans_symbol(coder.code(0, guesser.symbol_class(), rans_integer(symbol)));
}

/// Codes an index that is no guess; false where the free ones do not reach so far.
template <class Coder>
bool code_free_index(Coder& coder, const IndexGuesser& guesser, const FreeIndices& free,
                     uint32_t& index) {
  const int64_t likely = free.rank(guesser.likely());
  int64_t missed = 0;
  if constexpr (!kDecodes<Coder>) missed = free.rank(index) - likely;
  const int64_t rank =
      likely + coder.code(0, guesser.difference_class(), static_cast<int32_t>(missed));
  if (rank < 0 || rank >= free.count()) return false;
  index = free.select(static_cast<uint32_t>(rank));
  return true;
}

/// Codes the output index of every vertex, a permutation; false where it is none. `Coder` is a
/// RansEncoder or RansDecoder of one lane.
template <class Coder>
bool code_plain_order(Coder& coder, const MeshWalk& walk, std::vector<uint32_t>& output_index) {
  IndexGuesser guesser(walk);
  FreeIndices free(walk.turns());
  for (uint32_t turn = 0; turn < walk.turns(); ++turn) {
    uint32_t& index = output_index[walk.order[turn]];
    guesser.start(turn);
    const uint32_t symbol = code_symbol(coder, guesser, index);
    const bool there = symbol == IndexGuesser::kNone ? code_free_index(coder, guesser, free, index)
                                                     : guesser.find(symbol, index);
    if (!there) return false;
    free.take(index);
    guesser.note(index);
  }
  return true;
}

}  // namespace reeb
