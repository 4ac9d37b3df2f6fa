// Streams for the tests of the bindings.
#pragma once

#include "tests/codec/round_trip.h"
#include "tests/codec/shapes.h"

namespace reeb::test {

/// Two shots, 8 frames, 3 groups, 48 and a few vertices, 25 frames a second, named "tiny".
inline const Bytes& tiny_stream() {
  static const Bytes bytes = [] {
    Sequence sequence = sequence_of({animate(torus(8, 6), 6), animate(mixed_polygons(), 2)});
    sequence.frame_rate = 25;
    sequence.metadata = {{"name", "tiny"}, {"unit", "cm"}};
    EncodeOptions options = quick_options();
    options.target_value = 3;
    options.group_length = 3;
    return encode_or_fail(sequence, options).bytes;
  }();
  return bytes;
}

inline const Sequence& tiny_sequence() {
  static const Sequence sequence = decode_or_fail(tiny_stream());
  return sequence;
}

inline std::span<const float> tiny_frame(uint32_t frame) {
  return frame < 6 ? tiny_sequence().shots[0].frame(frame)
                   : tiny_sequence().shots[1].frame(frame - 6);
}

}  // namespace reeb::test
