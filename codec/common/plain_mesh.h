// What the reference mesh of the fast profile codes in its own way: positions as a field on the
// surface graph, which needs no position, and output indices as differences.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "codec/common/prediction_graph.h"
#include "entropy/rans.h"

namespace reeb {

/// Weights that predict positions: the mean of the ring, moved away from the mean of the neighbours
/// beyond, so that curved surfaces do not shrink.
std::vector<float> position_weights(const PredictionGraph& graph);

/// Codes the output index of every coding vertex (`output_index` has their number of entries) by
/// its difference from the one before; the class is the last difference's symbol. `Coder` is a
/// RansEncoder or RansDecoder. False where an index is out of range.
template <class Coder>
bool code_index_steps(Coder& coder, std::vector<uint32_t>& output_index) {
  const auto count = static_cast<int64_t>(output_index.size());
  int64_t before = -1;
  uint32_t cls = 0;
  for (uint32_t v = 0; v < output_index.size(); ++v) {
    const auto wanted = static_cast<int32_t>(int64_t{output_index[v]} - before - 1);
    const int32_t step = coder.code(0, cls, wanted);
    before += 1 + int64_t{step};
    if (before < 0 || before >= count) return false;
    output_index[v] = static_cast<uint32_t>(before);
    cls = std::min(rans_symbol(step), kRansClasses - 1);
  }
  return true;
}

}  // namespace reeb
