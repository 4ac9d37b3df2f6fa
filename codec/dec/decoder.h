// Decoder of `.reeb` streams: opens hostile bytes safely and gives any frame, bit-exact on every
// machine.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "bitstream/byte_source.h"
#include "bitstream/status.h"
#include "codec/common/base/sequence.h"
#include "codec/dec/attributes/render_mesh.h"
#include "codec/dec/attributes/site_numbers.h"
#include "codec/dec/decode_options.h"
#include "codec/dec/stream_info.h"

namespace reeb {

/// Where a frame goes. Vertex v's xyz is written to `positions + v * stride`, strides in floats
/// (>= 3).
struct FrameTarget {
  float* positions = nullptr;
  size_t stride = 3;
  /// Unit vertex normals, area-weighted from the frame's triangles, (0, 0, 0) at a vertex without
  /// one; nullptr = not wanted.
  float* normals = nullptr;
  size_t normal_stride = 3;
  /// Vertices that there is room for; a frame with more is refused.
  size_t vertex_capacity = SIZE_MAX;
};

/// How playing went, since opening or `reset_stats`.
struct DecodeStats {
  uint64_t frames = 0;          ///< given
  uint64_t groups_decoded = 0;  ///< in all, by now
  uint64_t groups_ahead = 0;    ///< of these, by the thread that decodes ahead
  double longest_stall = 0;     ///< seconds that the slowest frame took
  uint32_t longest_stall_frame = 0;
  uint64_t memory = 0, peak_memory = 0;  ///< bytes accounted for now, and at most
};

/// One open stream. Calls on one object may come from any thread; they take turns, except for
/// `cancel`. Objects know nothing of each other. Every Status may be kOutOfMemory; the object stays
/// usable after any error.
class Decoder {
 public:
  /// Reads and checks all chunks, decodes nothing. The bytes must outlive the decoder.
  static Status open(std::span<const uint8_t> bytes, const DecodeOptions& options,
                     std::unique_ptr<Decoder>& decoder);

  /// Reads headers through `source`; payloads only when they are needed, and by the seek table, if
  /// it is sound. Damage in them is found then.
  static Status open(std::unique_ptr<ByteSource> source, const DecodeOptions& options,
                     std::unique_ptr<Decoder>& decoder);

  /// Bytes come by `push`, which keeps them; frames can be had as soon as their group is there.
  static Status open_pushed(const DecodeOptions& options, std::unique_ptr<Decoder>& decoder);

  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  /// Adds bytes at the end of the file. After an error the stream stays as far as it was.
  Status push(std::span<const uint8_t> bytes);
  /// There are no more. What is missing is now truncated, no longer waited for.
  Status finish();

  /// Not to be read while another thread pushes. Empty until the sequence header is there.
  const StreamInfo& info() const;

  /// Faces of the shot that holds `frame`. The pointer lives as long as the decoder.
  Status connectivity(uint32_t frame, const Connectivity*& out);
  /// The same as triangles, three vertices each: every face as a fan around its first corner, faces
  /// of fewer than three left out.
  Status triangles(uint32_t frame, std::span<const uint32_t>& out);

  /// Any order of frames; costs at most one group and those that it continues, nothing but a small
  /// product when the group is kept.
  Status decode_frame(uint32_t frame, float* xyz, size_t stride = 3) {
    return decode_frame(frame, FrameTarget{.positions = xyz, .stride = stride});
  }
  Status decode_frame(uint32_t frame, const FrameTarget& target);

  /// Frames first .. first + count - 1, frame t at xyz + (t - first) * frame_stride, xyz after xyz.
  /// Sixteen or more at once take half the time of one after another, or less. After an error the
  /// frames before it are there.
  Status decode_frames(uint32_t first, uint32_t count, float* xyz, size_t frame_stride);

  /// The pose at a time in frames, 0 .. frame_count - 1: linear between the two frames around it,
  /// the earlier one where the connectivity changes between them.
  Status decode_at(double time, const FrameTarget& target);

  /// The attributes of the shot that holds `frame`, in order, without values. One that is damaged
  /// is left out, so that `indices` tells which there are.
  Status attributes(uint32_t frame, std::vector<Attribute>& out, std::vector<uint32_t>& indices);

  /// Attribute `index` with its values in `frame`. It is decoded once and kept.
  Status decode_attribute(uint32_t frame, uint32_t index, Attribute& out);

  /// The same into the caller's memory, element after element; or, with a render mesh of the shot,
  /// those of its vertices, for attributes of faces of its triangles.
  Status decode_values(uint32_t frame, uint32_t index, const RenderMesh* mesh,
                       const ValueTarget& target);
  /// What value `entry` of an attribute is called.
  Status attribute_name(uint32_t frame, uint32_t index, uint32_t entry, std::string& out);

  /// A mesh for graphics interfaces of the shot that holds `frame`, split where any of the
  /// attributes `split_by` differs around a vertex, its triangles sorted by the shot's first static
  /// material. It lives as long as the decoder, at most.
  Status make_render_mesh(uint32_t frame, std::span<const uint32_t> split_by,
                          std::unique_ptr<const RenderMesh>& out);
  /// A frame, or the pose at a time, at the vertices of a render mesh; normals are those of the
  /// shot's vertices.
  Status decode_frame(uint32_t frame, const RenderMesh& mesh, const FrameTarget& target);
  Status decode_at(double time, const RenderMesh& mesh, const FrameTarget& target);

  /// Resource `index` of those in `info`.
  Status resource(uint32_t index, Resource& out);
  /// As many of its bytes as `buffer` holds; `length`: how many there are.
  Status copy_resource(uint32_t index, std::span<uint8_t> buffer, size_t& length);

  /// With prefetch: the frame after the last is the first one, and the other way round.
  void set_loop(bool loop);

  /// Ends calls that are running now with kCancelled, soon. Any thread, at any time.
  void cancel();

  DecodeStats stats() const;
  void reset_stats();

 private:
  struct Impl;
  explicit Decoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// All frames at once, groups in parallel on `options.threads`, output included in
/// `options.limits.max_memory`. kTruncated where the stream ends early and kCorrupt where groups
/// are damaged; `out` has then all frames that could be decoded, one after another, and `missing`,
/// where it is wanted, says which could not.
Status decode_sequence(std::span<const uint8_t> bytes, const DecodeOptions& options, Sequence& out,
                       std::vector<StreamInfo::Gap>* missing = nullptr);

}  // namespace reeb
