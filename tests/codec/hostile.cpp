#include "tests/codec/hostile.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/codec/allocation_meter.h"
#include "tests/codec/shapes.h"

namespace reeb::test {

namespace {

constexpr uint64_t kSlack = 1u << 20;  // models, headers and names

StreamKind make(const std::string& name, EncodeOptions options, const Shape& shape = torus(4, 3)) {
  // Faces that take every part of the reference mesh, in one stream of each kind of positions.
  const bool every_part = name == "main" || name == "fast" || name == "lossless";
  const Shape other = every_part ? mixed_polygons() : fins(3);
  Sequence sequence = sequence_of({animate(shape, 6), animate(other, 2)});
  sequence.metadata = {{"name", "hostile"}};
  sequence.frame_rate = 24;
  if (options.group_length == 0) options.group_length = 3;
  return {name, encode_or_fail(sequence, options).bytes};
}

}  // namespace

std::vector<StreamKind> stream_kinds() {
  std::vector<StreamKind> out;
  EncodeOptions plain = quick_options();
  plain.target_value = 3;
  EncodeOptions o = plain;
  out.push_back(make("main", o));
  o.regions = 2;
  o.open_groups = 1;
  out.push_back(make("main with regions, open groups", o));
  o.open_groups = 0;
  o.reorder = true;
  o.profile = Profile::kFast;
  out.push_back(make("fast with regions, reordered", o));
  o = plain;
  o.profile = Profile::kFast;
  out.push_back(make("fast", o));
  o = plain;
  o.profile = Profile::kThesis;
  o.regions = 2;
  out.push_back(make("thesis", o));
  o = plain;
  o.target = Target::kMaxError;
  o.target_value = 1e-3;
  o.group_length = 6;
  out.push_back(make("bounded", o, torus(12, 8)));
  o = plain;
  o.target = Target::kLossless;
  out.push_back(make("lossless", o));
  o.effort = 1;
  out.push_back(make("lossless, quick", o));
  return out;
}

Limits tight_limits() {
  return {.max_vertices = 2000, .max_faces = 4000, .max_frames = 100, .max_memory = 8u << 20};
}

Outcome probe(const Bytes& bytes, const Limits& limits) {
  DecodeOptions options;
  options.limits = limits;
  Outcome out;
  std::unique_ptr<Decoder> decoder;
  out.opened = Decoder::open(bytes, options, decoder);
  if (!out.opened.ok()) return out;
  std::vector<float> xyz;
  const uint32_t count = std::min(decoder->info().frame_count, 20u);
  for (uint32_t frame = 0; frame < count; ++frame) {
    const Connectivity* connectivity = nullptr;
    Status status = decoder->connectivity(frame, connectivity);
    if (status.ok()) {
      REQUIRE(std::all_of(connectivity->corners.begin(), connectivity->corners.end(),
                          [&](uint32_t corner) { return corner < connectivity->vertex_count; }));
      xyz.resize(size_t{connectivity->vertex_count} * 3);
      status = decoder->decode_frame(frame, xyz.data());
    }
    ++(status.ok() ? out.frames : out.refused);
  }
  return out;
}

Outcome metered_probe(const Bytes& bytes, const Limits& limits) {
  const AllocationMeter meter;
  const Outcome out = probe(bytes, limits);
  CHECK(meter.peak() <= limits.max_memory + kSlack);
  return out;
}

}  // namespace reeb::test
