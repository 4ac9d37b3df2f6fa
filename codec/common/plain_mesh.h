// What the reference mesh of the fast profile codes in its own way: positions as a field on the
// surface graph, which needs no position, and output indices as differences.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/common/prediction_graph.h"
#include "entropy/rans.h"

namespace reeb {

/// Of every vertex the last one before it that shares a triangle with it, else the one before it;
/// 0 of vertex 0.
std::vector<uint32_t> find_leaders(uint32_t vertex_count, std::span<const uint32_t> triangles);

/// Codes the output index of every coding vertex (`output_index` has their number of entries) by
/// its difference from its leader's; the class is the last difference's symbol. `Coder` is a
/// RansEncoder or RansDecoder. False where an index is out of range.
template <class Coder>
bool code_index_steps(Coder& coder, std::span<const uint32_t> triangles,
                      std::vector<uint32_t>& output_index) {
  const auto count = static_cast<uint32_t>(output_index.size());
  const std::vector<uint32_t> leader = find_leaders(count, triangles);
  uint32_t cls = 0;
  for (uint32_t v = 0; v < count; ++v) {
    const int64_t next = v == 0 ? 0 : int64_t{output_index[leader[v]]} + 1;
    const int32_t step = coder.code(0, cls, static_cast<int32_t>(int64_t{output_index[v]} - next));
    const int64_t index = next + step;
    if (index < 0 || index >= count) return false;
    output_index[v] = static_cast<uint32_t>(index);
    cls = std::min(rans_symbol(step), kRansClasses - 1);
  }
  return true;
}

}  // namespace reeb
