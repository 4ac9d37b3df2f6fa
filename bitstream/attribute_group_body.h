// What follows the header of chunk `agrp`.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "bitstream/attribute_headers.h"

namespace reeb {

/// A number is `scale` times the coordinate that is decoded in its place.
struct ChannelScale {
  double scale = 1;
  bool operator==(const ChannelScale&) const = default;
};

template <class V>
void describe(V& v, ChannelScale& h) {
  v.f64("scale", h.scale, std::numeric_limits<double>::min(), ChannelHeader::kMaxNumber);
}

/// Three channels in a row, coded as positions are.
struct ChannelPart {
  uint64_t bytes = 0;
  bool operator==(const ChannelPart&) const = default;
};

template <class V>
void describe(V& v, ChannelPart& h) {
  v.uv("part_bytes", h.bytes, 0, kMaxUint32);
}

/// The parts follow in order and fill the rest; each is the payload of a `GRUP`.
struct AttributeGroupBody {
  std::vector<ChannelScale> scales;  ///< of each channel
  std::vector<ChannelPart> parts;    ///< of channels 0 .. 2, 3 .. 5, ...
};

template <class V>
void describe(V& v, AttributeGroupBody& h) {
  v.list("scale_count", h.scales, 2);
  v.list("part_count", h.parts, 1);
}

}  // namespace reeb
