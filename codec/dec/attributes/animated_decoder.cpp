#include "codec/dec/attributes/animated_decoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "bitstream/attribute_group_body.h"
#include "bitstream/bytes.h"
#include "bitstream/group_payload.h"
#include "bitstream/syntax.h"
#include "codec/common/attributes/numbers.h"
#include "codec/common/base/attributes.h"
#include "codec/dec/attributes/attribute_decoder.h"
#include "codec/dec/group_memory.h"
#include "codec/dec/stoppable_decoder.h"

namespace reeb {

namespace {

constexpr uint32_t kPart = 3;  ///< channels

Status damaged() { return Status::corrupt("the group of an attribute is damaged"); }

/// What a part may be: closed, without a motion model, of the group's frames.
bool fits(const GroupHeader& part, const AttributeGroupHeader& group) {
  return part.first_frame == group.first_frame && part.frame_count == group.frame_count &&
         part.shot == group.shot && part.profile != Profile::kThesis && part.region_count == 0 &&
         (part.flags & GroupHeader::kContinues) == 0;
}

/// The number of a channel that is decoded as `coordinate`, at `to`.
void store(ValueType type, double scale, float coordinate, uint8_t* to) {
  const double number = scale * static_cast<double>(coordinate);
  if (type == ValueType::kBinary32) {
    const float x = static_cast<float>(
        std::clamp(number, -ChannelHeader::kMaxNumber, ChannelHeader::kMaxNumber));
    std::memcpy(to, &x, sizeof x);
    return;
  }
  const IntegerRange range = integer_range(type);
  const double clamped = std::clamp(std::floor(number + 0.5), static_cast<double>(range.low),
                                    static_cast<double>(range.high));
  store_integer(type, static_cast<int64_t>(clamped), to);
}

}  // namespace

AttributeSurface attribute_surface(Sites sites, const StopToken& stop) {
  AttributeSurface out;
  ReferenceMesh mesh;
  mesh.vertex_count = sites.mesh.count;
  mesh.grid = std::move(sites.mesh.grid);
  mesh.triangles = std::move(sites.mesh.triangles);
  out.surface.surface = Surface(mesh, stop);
  out.surface.output = out.surface.surface.order;
  out.of_element = std::move(sites.of_element);
  return out;
}

Status decode_attribute_sites(const AttributeChunk& chunk, const ShotSurface& surface,
                              const StopToken& stop, Sites& out, std::vector<float>& corrections) {
  AttributeBody body;
  std::span<const uint8_t> section;
  if (Status s = read_attribute_body(chunk, body, section); !s.ok()) return s;
  StoppableDecoder coder(section, stop);
  out = code_sites(coder, chunk.header.domain, surface, [](uint32_t, uint32_t) { return false; });
  if (!body.channels.empty()) {
    std::vector<uint32_t> integers;
    if (Status s = code_integers(coder, chunk.header, body, surface, out.mesh, integers); !s.ok())
      return s;
    for (size_t i = 0; i < integers.size(); ++i)
      corrections.push_back(std::bit_cast<float>(
          binary32_bits(body.channels[i % body.channels.size()], integers[i])));
  }
  return coder.overrun() ? Status::corrupt("the sites of an attribute are cut off") : Status();
}

uint64_t attribute_surface_memory(uint64_t elements) {
  MeshHeader mesh;
  mesh.vertex_count = static_cast<uint32_t>(elements);
  return reference_memory(mesh, 0);
}

uint64_t AttributeGroupParts::memory(uint64_t sites) const {
  uint64_t most = 0;
  for (const GroupChunk& part : parts)
    most = std::max(most, group_memory(sites, part.header, false));
  return most + kept(sites);
}

uint64_t AttributeGroupParts::kept(uint64_t sites) const {
  uint64_t sum = 0;
  for (const GroupChunk& part : parts) sum += kept_memory(sites, part.header);
  return sum;
}

Status read_attribute_group(const AttributeHeader& header, const AttributeGroupChunk& chunk,
                            AttributeGroupParts& out) {
  AttributeGroupBody body;
  ByteReader in(chunk.sections);
  if (Status s = read_header(in, "agrp", body); !s.ok()) return s;
  const uint32_t parts = (header.coded_channels() + kPart - 1) / kPart;
  if (body.scales.size() != header.coded_channels() || body.parts.size() != parts)
    return Status::corrupt("agrp: not a scale for every channel, or a part for every three");
  for (const ChannelScale& s : body.scales) out.scales.push_back(s.scale);
  for (const ChannelPart& p : body.parts) {
    GroupChunk& part = out.parts.emplace_back();
    const std::span<const uint8_t> payload = in.take(p.bytes);
    if (!in.ok()) return damaged();
    if (Status s = read_group_payload(payload, part); !s.ok()) return s;
    if (!fits(part.header, chunk.header)) return damaged();
  }
  return in.remaining() == 0 ? Status() : damaged();
}

Status decode_attribute_group(const AttributeGroupParts& parts, const AttributeSurface& surface,
                              unsigned threads, const StopToken& stop, AttributeFrames& out) {
  out = {};
  out.scales = parts.scales;
  for (const GroupChunk& part : parts.parts) {
    GroupState state;
    if (Status s = decode_group(part, surface.surface, threads, false, state,
                                out.parts.emplace_back(), stop);
        !s.ok())
      return s;
  }
  return {};
}

std::vector<uint8_t> attribute_frame(const AttributeHeader& header, const AttributeSurface& surface,
                                     const AttributeFrames& frames, uint32_t t) {
  const size_t sites = surface.surface.output.size();
  const uint32_t channels = header.coded_channels();
  const size_t size = size_of(header.type), bytes = channels * size;
  std::vector<uint8_t> numbers(sites * bytes);
  std::vector<float> coordinates(kPart * sites);
  for (uint32_t k = 0; k < channels; ++k) {
    if (k % kPart == 0) frames.parts[k / kPart].frame(t, coordinates.data(), kPart);
    for (size_t i = 0; i < sites; ++i)
      store(header.type, frames.scales[k], coordinates[i * kPart + k % kPart],
            &numbers[i * bytes + k * size]);
  }
  return numbers;
}

}  // namespace reeb
