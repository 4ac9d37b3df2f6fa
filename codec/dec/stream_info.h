// What a stream holds.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bitstream/container.h"

namespace reeb {

/// Known after opening, without decoding a frame.
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
    uint32_t component_count = 0;  ///< terms that positions are the sum of; 0 in lossless groups
    uint64_t bytes = 0;
    bool continues = false;  ///< decodes only after the group before
    Profile profile = Profile::kMain;
    uint32_t stored_count = 0;  ///< lossless: frames that are not copies
  };
  struct ShotInfo {
    uint32_t first_frame = 0;
    uint32_t frame_count = 0;
    uint32_t vertex_count = 0;
    uint32_t face_count = 0;
    bool order_kept = true;  ///< vertices come back in the order of the input
  };
  /// Frames whose group or reference mesh is damaged or cut off.
  struct Gap {
    uint32_t first_frame = 0;
    uint32_t frame_count = 0;
  };
  struct AttributeInfo {
    AttributeHeader header;
    uint64_t bytes = 0;  ///< of its chunks
  };
  struct ResourceInfo {
    ResourceHeader header;
    uint64_t bytes = 0;  ///< of its chunk
  };
  uint32_t format_version = 0;
  double frame_rate = 0;
  double start_time = 0;
  uint32_t frame_count = 0;   ///< up to the last one that can be decoded
  uint32_t total_frames = 0;  ///< of the sequence as it was encoded
  bool truncated = false;     ///< the stream ends early; whole groups before the cut are here
  std::vector<ShotInfo> shots;
  std::vector<Group> groups;  ///< those that can be decoded, as far as is known without trying
  std::vector<Gap> missing;   ///< ascending; those past frame_count are there, too
  std::vector<Section> sections;
  std::vector<std::pair<std::string, std::string>> metadata;
  std::vector<AttributeInfo> attributes;  ///< shot after shot
  std::vector<ResourceInfo> resources;
  std::vector<Box> bounds;  ///< of the groups, one each; empty where the file does not tell
  std::vector<DamagedRange> damaged;
  uint64_t file_bytes = 0;
};

/// Bytes of memory that telling what the container has takes at most.
uint64_t info_memory(const ContainerReader& container);

/// Adds what the container has from its group `first_group` on; what `info` has of those before it
/// stays. `missing` is only found where the file is `complete`.
void update_info(const ContainerReader& container, uint64_t file_bytes, bool complete,
                 size_t first_group, StreamInfo& info);

}  // namespace reeb
