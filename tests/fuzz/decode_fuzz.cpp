// A whole stream, its checksums repaired so that damage reaches the payloads: every frame there is,
// with its attributes, decodes or is refused, within the limits, and the same a second time.
#include <algorithm>
#include <vector>

#include "codec/dec/decoder.h"
#include "tests/codec/damage.h"

namespace {

constexpr uint32_t kMaxFrames = 8;

/// The attributes of a frame, one after another, those that decode.
std::vector<uint8_t> decode_attributes(reeb::Decoder& decoder, uint32_t frame) {
  std::vector<reeb::Attribute> attributes;
  std::vector<uint32_t> indices;
  std::vector<uint8_t> out;
  if (!decoder.attributes(frame, attributes, indices).ok()) return out;
  for (const uint32_t index : indices) {
    reeb::Attribute attribute;
    if (!decoder.decode_attribute(frame, index, attribute).ok()) continue;
    out.insert(out.end(), attribute.values.begin(), attribute.values.end());
  }
  return out;
}

/// The values of attributes at the render vertices of a mesh that is split by all of them.
std::vector<uint8_t> decode_render_values(reeb::Decoder& decoder, uint32_t frame) {
  std::vector<reeb::Attribute> attributes;
  std::vector<uint32_t> indices;
  std::vector<uint8_t> out;
  std::unique_ptr<const reeb::RenderMesh> mesh;
  if (!decoder.attributes(frame, attributes, indices).ok()) return out;
  if (!decoder.make_render_mesh(frame, indices, mesh).ok()) return out;
  for (const uint32_t v : mesh->triangles) {
    if (v >= mesh->vertex_count()) __builtin_trap();
  }
  for (size_t i = 0; i < indices.size(); ++i) {
    const size_t elements = std::max(mesh->triangles.size() / 3, mesh->source_vertex.size()) + 1;
    std::vector<uint8_t> values(elements * attributes[i].element_bytes());
    const reeb::ValueTarget target{values.data(), 0, elements};
    if (decoder.decode_values(frame, indices[i], mesh.get(), target).ok())
      out.insert(out.end(), values.begin(), values.end());
  }
  return out;
}

/// Attributes and positions of all frames.
std::vector<uint8_t> decode(std::span<const uint8_t> bytes, bool backwards) {
  reeb::DecodeOptions options;
  options.limits = {
      .max_vertices = 1024, .max_faces = 2048, .max_frames = 4096, .max_memory = 64u << 20};
  std::unique_ptr<reeb::Decoder> decoder;
  if (!reeb::Decoder::open(bytes, options, decoder).ok()) return {};
  const uint32_t count = std::min(decoder->info().frame_count, kMaxFrames);
  std::vector<std::vector<uint8_t>> frames(count);
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t frame = backwards ? count - 1 - i : i;
    const reeb::Connectivity* connectivity = nullptr;
    if (!decoder->connectivity(frame, connectivity).ok()) continue;
    for (const uint32_t corner : connectivity->corners) {
      if (corner >= connectivity->vertex_count) __builtin_trap();
    }
    frames[frame] = decode_attributes(*decoder, frame);
    const std::vector<uint8_t> rendered = decode_render_values(*decoder, frame);
    frames[frame].insert(frames[frame].end(), rendered.begin(), rendered.end());
    std::vector<float> xyz(size_t{connectivity->vertex_count} * 3);
    if (!decoder->decode_frame(frame, xyz.data()).ok()) continue;
    const auto* raw = reinterpret_cast<const uint8_t*>(xyz.data());
    frames[frame].insert(frames[frame].end(), raw, raw + xyz.size() * sizeof(float));
  }
  std::vector<uint8_t> out;
  for (const auto& f : frames) out.insert(out.end(), f.begin(), f.end());
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::vector<uint8_t> file(data, data + size);
  reeb::test::repair_checksums(file);
  if (decode(file, false) != decode(file, true)) __builtin_trap();
  return 0;
}
