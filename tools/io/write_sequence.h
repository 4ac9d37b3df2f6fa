// Sequences into any format the tools write, chosen by the output name.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bitstream/status.h"
#include "codec/common/base/sequence.h"

namespace reeb::tools {

/// A frame to write.
struct SourceFrame {
  const Connectivity* connectivity = nullptr;  ///< valid until all is written
  std::vector<float> positions;                ///< [vertex][xyz]
  std::vector<Attribute> attributes;           ///< with the values of the frame alone
};

/// Frames to write, asked for one after another.
struct FrameSource {
  std::vector<uint32_t> numbers;  ///< the number of each frame in its file name, in order of output
  double frame_rate = 0;          ///< frames per second; 0 where unknown
  double start_time = 0;          ///< of the first frame written, in frames
  double frames_per_sample = 1;   ///< see PointCache
  uint64_t least_bytes = 0;       ///< that the output will take, likely
  std::vector<Resource> resources = {};  ///< files that go beside meshes that name them
  /// Gives output frame i.
  std::function<Status(uint32_t i, SourceFrame& out)> frame;
};

/// All frames of `sequence`, numbered from 1. The sequence must outlive the source.
FrameSource source_of(const Sequence& sequence);

struct WriteOptions {
  std::string format = {};  ///< see `parse_output_name`
  bool overwrite = false;
  unsigned threads = 0;  ///< 0 = all cores
  /// Called with the done part in [0,1]. May be empty.
  std::function<void(double)> progress = {};
  std::vector<std::string>* notes = nullptr;  ///< gets what the format does not take
};

/// What an output name stands for.
struct OutputName {
  enum class Kind { kFrames, kSingleMesh, kCache };
  Kind kind = Kind::kFrames;
  std::string pattern;        ///< kFrames: with a %d field; kSingleMesh, kCache: the file
  std::string extension;      ///< of the format, ".obj"
  bool faces_beside = false;  ///< kCache: with an .obj of the same name
};

/// Names: `out/f_%04d.obj` (also .ply, .off, .stl), a folder (frame_%04d.obj in it), `out.pc2` or
/// `out.mdd` (their faces go to `out.obj`), `out.obj` for one frame; "-", or anything else that is
/// neither file nor folder, for the bytes of a cache or of one mesh. `format` ("obj", "pc2") says
/// what names without an extension hold; empty: .obj, a .pc2 where several frames need one file.
Status parse_output_name(const std::string& output, uint32_t frame_count, const std::string& format,
                         OutputName& out);

/// Writes all frames, or nothing at all. Missing folders are created.
Status write_sequence(const FrameSource& source, const std::string& output,
                      const WriteOptions& options);

}  // namespace reeb::tools
