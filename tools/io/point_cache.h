// Point caches: the positions of all frames in one file, the faces in a mesh beside it.
//
// PC2 (Point Cache 2), little endian: "POINTCACHE2\0", int32 version 1, int32 points, float32 start
// frame, float32 frames per sample, int32 samples; then float32 xyz [sample][point].
// MDD (Motion Designer), big endian: int32 frames, int32 points, float32 time of each frame in
// seconds; then float32 xyz [frame][point].
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"

namespace reeb::tools {

enum class CacheFormat { kPc2, kMdd };

/// By the extension, in any case.
std::optional<CacheFormat> cache_format(const std::filesystem::path& path);

/// Metadata key that keeps the "frames per sample" of a PC2 where it is not 1.
inline constexpr const char* kSampleRateKey = "pc2.frames_per_sample";

struct PointCache {
  uint32_t point_count = 0;
  uint32_t frame_count = 0;
  double frame_rate = 0;  ///< frames per second; 0 in a PC2, which has none
  double start_time = 0;  ///< of the first frame, in frames
  double frames_per_sample = 1;
  std::vector<float> positions;    ///< [frame][point][xyz], finite
  std::vector<std::string> notes;  ///< e.g. times that are not evenly spaced
};

/// Nothing is allocated before the size of the file has confirmed the counts. The message of a
/// failure names the file, the frame and the remedy. `progress`, which may be empty, is called with
/// the done part in [0,1].
Status read_point_cache(const std::filesystem::path& path, PointCache& out,
                        const std::function<void(double)>& progress = {});

/// The same from an open file of `size` bytes, `name` for messages.
Status read_point_cache(std::FILE* file, uint64_t size, const std::string& name, CacheFormat format,
                        PointCache& out, const std::function<void(double)>& progress = {});

/// What precedes the positions. An MDD needs a `frame_rate` above 0.
std::string cache_header(CacheFormat format, uint32_t point_count, uint32_t frame_count,
                         double frame_rate, double start_time, double frames_per_sample);

/// Positions in the byte order of the format.
std::string cache_positions(CacheFormat format, std::span<const float> positions);

}  // namespace reeb::tools
