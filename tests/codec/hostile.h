// Streams of every kind, small, and a decoder that must survive whatever is made of them.
#pragma once

#include <string>
#include <vector>

#include "tests/codec/round_trip.h"

namespace reeb::test {

/// A stream of two shots, two or three groups and metadata; eight frames.
struct StreamKind {
  std::string name;
  Bytes bytes;
};
std::vector<StreamKind> stream_kinds();

Limits tight_limits();

struct Outcome {
  Status opened;
  uint32_t frames = 0;  ///< decoded
  uint32_t refused = 0;
};

/// Opens and decodes whatever the bytes hold, within the limits.
Outcome probe(const Bytes& bytes, const Limits& limits);

/// The same, and checks that the memory stays within the limit.
Outcome metered_probe(const Bytes& bytes, const Limits& limits);

}  // namespace reeb::test
