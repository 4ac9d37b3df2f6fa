// An animated mesh in memory, as the encoder takes it and the tools read and write it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "codec/common/base/attributes.h"

namespace reeb {

/// Polygons over the vertices 0 .. vertex_count-1, in the order of the input. Anything goes:
/// isolated vertices, degenerate and repeated faces, non-manifold edges; a face has at least one
/// corner.
struct Connectivity {
  uint32_t vertex_count = 0;
  std::vector<uint32_t> face_sizes;  ///< corners of each face
  std::vector<uint32_t> corners;     ///< vertex of every corner, faces one after another

  bool operator==(const Connectivity&) const = default;
};

/// A run of consecutive frames with one connectivity.
struct Shot {
  Connectivity connectivity;
  uint32_t frame_count = 0;
  std::vector<float>
      positions;  ///< [frame][vertex][xyz], frame_count * vertex_count * 3 finite values
  std::vector<Attribute> attributes = {};  ///< at most kMaxAttributes

  /// Vertices, corners, faces, or 1.
  size_t element_count(Domain domain) const {
    return domain == Domain::kVertex   ? connectivity.vertex_count
           : domain == Domain::kCorner ? connectivity.corners.size()
           : domain == Domain::kFace   ? connectivity.face_sizes.size()
                                       : 1;
  }

  std::span<const float> frame(uint32_t t) const {
    const size_t n = size_t{connectivity.vertex_count} * 3;
    return {positions.data() + t * n, n};
  }
};

/// Shots one after another; most sequences have exactly one.
struct Sequence {
  std::vector<Shot> shots;
  double frame_rate = 0;  ///< frames per second; 0 where unknown
  double start_time = 0;  ///< time of the first frame in frames, as point caches keep it
  std::map<std::string, std::string> metadata;  ///< free key/value pairs, UTF-8
  std::vector<Resource> resources = {};

  uint32_t frame_count() const {
    uint32_t n = 0;
    for (const Shot& s : shots) n += s.frame_count;
    return n;
  }
};

}  // namespace reeb
