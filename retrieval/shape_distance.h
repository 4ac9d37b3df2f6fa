// How unlike two shapes are.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieval/signature.h"

namespace reeb::retrieval {

/// 0 for equal charts, below 1.
double chart_distance(const ChartSignature& a, const ChartSignature& b);

struct ChartMatch {
  std::vector<uint32_t> match;  ///< per chart of the first shape, one of the second, or kUnmatched
  double distance = 0;          ///< 0 .. 1: what is unlike, or without a match, weighted by size
};

inline constexpr uint32_t kUnmatched = 0xffffffffu;

/// The matching of charts under which the shapes are most alike, charts of neighbours that match
/// each other being preferred to others as alike.
ChartMatch match_charts(const Signature& a, const Signature& b);

/// Parts of the distance, in units of what is typical between different shapes.
struct ShapeDistance {
  double charts = 0;    ///< match_charts
  double spectrum = 0;  ///< heat and wave kernel signatures
  double body = 0;      ///< local thickness, whatever the size, straightness, curvature, reach
  double total = 0;     ///< geometric mean of the seven parts, spectrum being two and body four:
                        ///< what one part tells for sure is not lost among the doubts of others
};

/// Neither signature is empty.
ShapeDistance shape_distance(const Signature& a, const Signature& b);

}  // namespace reeb::retrieval
