// How far attributes of a decoded sequence are from those of the original.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

struct AttributeComparison {
  std::string name;
  Semantic semantic = Semantic::kGeneric;
  std::string problem;  ///< why it was not compared in some frame; empty: it was in all
  bool identical = true;
  bool whole = true;              ///< whole numbers or names on both sides
  std::vector<double> max_error;  ///< of each channel
  double worst = 0;               ///< largest error of a channel; of normals angle, in degrees
  uint64_t compared = 0;          ///< elements, in all frames
  uint64_t different = 0;         ///< of these
  uint32_t worst_frame = 0;       ///< from 0, where that is

  /// What tolerances are held against: elements that differ where the numbers are whole, else
  /// `worst`; infinite where there is a problem.
  double figure() const;
};

/// By name, in the order of the original and then of the other. Pre-condition: `compare_sequences`
/// has compared the two with success. Where faces are in another order they are matched.
std::vector<AttributeComparison> compare_attributes(const Sequence& original,
                                                    const Sequence& other);

}  // namespace reeb::tools
