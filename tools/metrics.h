// How far a decoded sequence is from the original.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "tools/remainders.h"

namespace reeb::tools {

/// Error of one frame, or of all, in the units of the input.
struct ErrorFigures {
  double kg = 0;         ///< Karni-Gotsman error in percent, see `compare_sequences`
  double rmse = 0;       ///< root of the mean squared vertex displacement
  double max_error = 0;  ///< largest error of a coordinate
};

struct Comparison {
  ErrorFigures overall;
  std::vector<ErrorFigures> frames;
  double diagonal = 0;      ///< of the bounding box of all frames of the original
  uint64_t max_frame = 0;   ///< frame of the largest error, from 0
  uint64_t max_vertex = 0;  ///< its vertex, from 0
  bool identical = true;    ///< every coordinate has the same bits, and the same remainder

  /// The largest error by the diagonal; 0 where both are 0.
  double relative_max_error() const;
};

/// Compares vertex by vertex. The KG error is 100 ||A - B|| / ||A - mean(A)||, Frobenius norms over
/// all frames, the mean taken per frame and axis (Z. Karni, C. Gotsman, "Compression of soft-body
/// animation sequences", Computers & Graphics 28, 2004); infinite where only the denominator is 0.
///
/// The remainders of both sides are counted to their positions.
///
/// Fails, naming the frame, where the number of frames, the vertex counts or the faces differ.
Status compare_sequences(const Sequence& original, const Sequence& other, Comparison& out,
                         const Remainders& original_remainders = {},
                         const Remainders& other_remainders = {});

/// Vertices times frames: what bits per vertex and frame are divided by.
uint64_t vertex_frames(const Sequence& sequence);

/// Diagonal of the box around the positions of all frames; 0 for none.
double bounding_diagonal(const Sequence& sequence);

}  // namespace reeb::tools
