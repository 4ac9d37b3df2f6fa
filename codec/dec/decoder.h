// Decoder of `.reeb` streams: opens hostile bytes safely and gives any frame, bit-exact on every
// machine.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bitstream/limits.h"
#include "bitstream/status.h"
#include "codec/common/sequence.h"

namespace reeb {

struct DecodeOptions {
  Limits limits;         ///< refused beyond these, before anything is allocated
  unsigned threads = 1;  ///< 0 = all cores; results do not depend on it
};

/// What a stream holds, known after `open`.
struct StreamInfo {
  struct Section {
    std::string name;  ///< e.g. "reference mesh", "groups"
    uint64_t bytes = 0;
  };
  struct Group {
    uint32_t first_frame = 0;  ///< in the sequence
    uint32_t frame_count = 0;
    uint32_t shot = 0;
    uint32_t region_count = 0;     ///< regions of the affine motion model; 0 where it is not used
    uint32_t component_count = 0;  ///< temporal components; lossless: frames that are not copies
    uint64_t bytes = 0;
    bool continues = false;  ///< decodes only after the group before
    bool lossless = false;
  };
  struct ShotInfo {
    uint32_t first_frame = 0;
    uint32_t frame_count = 0;
    uint32_t vertex_count = 0;
    uint32_t face_count = 0;
    bool order_kept = true;  ///< vertices come back in the order of the input
  };
  uint32_t format_version = 0;
  double frame_rate = 0;
  double start_time = 0;
  uint32_t frame_count = 0;   ///< frames that can be decoded (fewer than coded when truncated)
  uint32_t total_frames = 0;  ///< frames that were coded, lost ones included
  bool truncated = false;     ///< the stream ends early; whole groups before the cut are here
  std::vector<ShotInfo> shots;
  std::vector<Group> groups;
  std::vector<Section> sections;
  std::vector<std::pair<std::string, std::string>> metadata;
  uint64_t file_bytes = 0;
};

/// One open stream. Not copyable; one thread at a time per object, several objects at once are
/// fine.
class Decoder {
 public:
  /// Reads headers, not frames. The bytes must outlive the decoder.
  static Status open(std::span<const uint8_t> bytes, const DecodeOptions& options,
                     std::unique_ptr<Decoder>& decoder);
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  const StreamInfo& info() const;

  /// Faces of the shot that holds `frame`. The pointer lives as long as the decoder.
  Status connectivity(uint32_t frame, const Connectivity*& out);

  /// Writes vertex v's xyz to `xyz + v * stride`, `stride` in floats (>= 3). Any order of frames;
  /// costs at most one group and those that it continues, nothing but a small product when the
  /// group is the one decoded last.
  Status decode_frame(uint32_t frame, float* xyz, size_t stride = 3);

 private:
  struct Impl;
  explicit Decoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// All frames at once.
Status decode_sequence(std::span<const uint8_t> bytes, const DecodeOptions& options, Sequence& out);

}  // namespace reeb
