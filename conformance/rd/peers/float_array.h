// Float32 positions for the general-purpose array codecs, laid out so that they do best.
#pragma once

#include "conformance/rd/peers/peer.h"

namespace reeb::conformance {

enum class Layout : uint32_t {
  kPlanes,   ///< [axis][frame][vertex]: three arrays of two dimensions
  kAsItLies  ///< [frame][vertex][axis]: one array of three dimensions
};

/// The positions in the layout named.
inline std::vector<float> laid_out(const Shot& shot, Layout layout) {
  if (layout == Layout::kAsItLies) return shot.positions;
  std::vector<float> planes;
  planes.reserve(shot.positions.size());
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t i = axis; i < shot.positions.size(); i += 3) planes.push_back(shot.positions[i]);
  }
  return planes;
}

/// Undoes `laid_out`.
inline std::vector<float> interleaved(std::vector<float> values, Layout layout) {
  if (layout == Layout::kAsItLies) return values;
  const size_t points = values.size() / 3;
  std::vector<float> positions(values.size());
  for (size_t i = 0; i < values.size(); ++i) positions[i % points * 3 + i / points] = values[i];
  return positions;
}

struct ArrayHeader {
  uint32_t vertices, frames;
  Layout layout;
};

}  // namespace reeb::conformance
