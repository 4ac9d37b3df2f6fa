#include "codec/enc/attributes/bounds.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "codec/dec/decoder.h"

namespace reeb {

namespace {

constexpr uint32_t kAtOnce = 16;  ///< frames, which take half the time then

void widen(std::span<const float> xyz, Box& box) {
  for (size_t i = 0; i < xyz.size(); ++i) {
    box.low[i % 3] = std::min(box.low[i % 3], xyz[i]);
    box.high[i % 3] = std::max(box.high[i % 3], xyz[i]);
  }
}

Status box_of(Decoder& decoder, const StreamInfo::Group& group, uint32_t vertices, Box& box) {
  constexpr float kMaxFloat = std::numeric_limits<float>::max();
  box = {{kMaxFloat, kMaxFloat, kMaxFloat}, {-kMaxFloat, -kMaxFloat, -kMaxFloat}};
  const size_t frame = size_t{vertices} * 3;
  std::vector<float> xyz(frame * kAtOnce);
  for (uint32_t t = 0; t < group.frame_count; t += kAtOnce) {
    const uint32_t count = std::min(kAtOnce, group.frame_count - t);
    if (Status s = decoder.decode_frames(group.first_frame + t, count, xyz.data(), frame); !s.ok())
      return s;
    widen(std::span(xyz).first(frame * count), box);
  }
  return {};
}

}  // namespace

Status find_bounds(std::span<const uint8_t> file, unsigned threads, GroupBoxes& out) {
  DecodeOptions options;
  options.threads = threads;
  options.limits = {.max_vertices = kMaxVertices,
                    .max_faces = UINT32_MAX,
                    .max_frames = UINT32_MAX,
                    .max_memory = UINT64_MAX};
  std::unique_ptr<Decoder> decoder;
  if (Status s = Decoder::open(file, options, decoder); !s.ok()) return s;
  out.groups.clear();
  for (const StreamInfo::Group& g : decoder->info().groups) {
    const uint32_t vertices = decoder->info().shots[g.shot].vertex_count;
    if (Status s = box_of(*decoder, g, vertices, out.groups.emplace_back()); !s.ok()) return s;
  }
  return {};
}

}  // namespace reeb
