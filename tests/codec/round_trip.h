// Encoding, decoding and measuring through the public interfaces, for the tests of the whole codec.
#pragma once

#include <set>
#include <vector>

#include "codec/common/base/sequence.h"
#include "codec/dec/decoder.h"
#include "codec/enc/encoder.h"

namespace reeb::test {

using Bytes = std::vector<uint8_t>;

/// KG error in percent at which even tiny meshes can be coded, and quickly.
EncodeOptions quick_options();

struct Encoded {
  Bytes bytes;
  EncodeStats stats;
};

/// Both require success.
Encoded encode_or_fail(const Sequence& sequence, const EncodeOptions& options);
Sequence decode_or_fail(const Bytes& bytes, unsigned threads = 1);

/// Figures as documented in EncodeStats, computed plainly.
struct Errors {
  double kg = 0;
  double rmse = 0;
  double largest = 0;
};
Errors measure(const Sequence& original, const Sequence& decoded);
double vertex_frames(const Sequence& sequence);

/// Faces, each from its smallest rotation on.
std::multiset<std::vector<uint32_t>> face_set(const Connectivity& connectivity);

bool same_positions(const Sequence& a, const Sequence& b);

/// A smoothly deforming torus of about 2,000 vertices and 40 frames.
Sequence large_sequence();

}  // namespace reeb::test
