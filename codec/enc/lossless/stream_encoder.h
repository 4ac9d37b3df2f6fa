// Lossless encoder of frames as they arrive, with memory for a group of them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bitstream/headers.h"
#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "codec/enc/lossless/lossless_group_encoder.h"

namespace reeb {

struct StreamOptions {
  uint32_t group_length = 0;   ///< frames per group, 1 .. 65536; 0 = as many as 64 MiB hold
  bool reorder = false;        ///< drop the order of vertices and faces (saves bits)
  bool face_order = true;      ///< faces come back in order, with their first corners
  LosslessMethod method = {};  ///< quick: several times as quick, files about a sixth larger
  unsigned threads = 0;        ///< 0 = all cores; the bytes do not depend on it
};

/// Takes the bytes of the file in order; false where it cannot.
using ByteSink = std::function<bool(std::span<const uint8_t>)>;

/// `begin`; for each shot `begin_shot` and its frames; `finish`. After an error nothing more can be
/// done.
class StreamEncoder {
 public:
  StreamEncoder(const StreamOptions& options, ByteSink sink);
  ~StreamEncoder();
  StreamEncoder(const StreamEncoder&) = delete;
  StreamEncoder& operator=(const StreamEncoder&) = delete;

  /// `header` and `metadata` as they go into the file.
  Status begin(const SequenceHeader& header, const std::vector<MetadataEntry>& metadata);
  Status begin_shot(const Connectivity& connectivity);
  /// Vertex by vertex xyz, finite; at least one frame per shot.
  Status add_frame(std::span<const float> xyz);
  Status finish();

  uint64_t bytes() const;  ///< handed to the sink so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reeb
