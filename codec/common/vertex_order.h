// Coder of the permutation from coding numbering to the order of the input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/reference_syntax.h"

namespace reeb {

/// Output indices not used yet, with ranks in logarithmic time.
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

/// Codes `output_index` of every coding vertex (a permutation).
class VertexOrderSyntax {
 public:
  template <class Coder>
  Status code(Coder& coder, uint32_t vertex_count, std::vector<uint32_t>& output_index) {
    FreeIndices free(vertex_count);
    uint32_t predicted = 0;
    for (uint32_t v = 0; v < vertex_count; ++v) {
      uint32_t& index = slot(output_index, v);
      const uint32_t base = std::min(free.rank(predicted), free.count() - 1);
      const int64_t rank =
          int64_t{base} + step_.code(coder, static_cast<int32_t>(free.rank(index) - base));
      if (rank < 0 || rank >= free.count() || ran_dry(coder)) {
        return Status::corrupt("mesh: the vertex order is no permutation");
      }
      index = free.select(static_cast<uint32_t>(rank));
      free.take(index);
      predicted = index;
    }
    return {};
  }

 private:
  SignedModel step_;
};

}  // namespace reeb
