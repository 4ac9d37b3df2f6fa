#include "codec/dec/attributes/attribute_decoder.h"

#include <cstring>
#include <utility>

#include "bitstream/bytes.h"
#include "bitstream/syntax.h"
#include "codec/common/attributes/attribute_syntax.h"
#include "codec/dec/guard.h"
#include "codec/dec/stoppable_decoder.h"

namespace reeb {

namespace {

void store(ValueType type, const ChannelHeader& channel, uint32_t n, uint8_t* to) {
  if (type == ValueType::kBinary32) {
    const uint32_t bits = binary32_bits(channel, n);
    std::memcpy(to, &bits, sizeof bits);
    return;
  }
  store_integer(type, integer_number(type, channel, n), to);
}

/// The numbers of all sites.
std::vector<uint8_t> numbers(const AttributeHeader& h, const AttributeBody& body,
                             const std::vector<uint32_t>& integers,
                             const std::vector<NumberException>& exceptions) {
  const size_t size = size_of(h.type);
  std::vector<uint8_t> out(integers.size() * size);
  for (size_t i = 0; i < integers.size(); ++i)
    store(h.type, body.channels[i % h.channel_count], integers[i], &out[i * size]);
  for (const NumberException& e : exceptions) std::memcpy(&out[e.index * size], &e.bits, 4);
  return out;
}

}  // namespace

Status read_attribute_body(const AttributeChunk& chunk, AttributeBody& body,
                           std::span<const uint8_t>& section) {
  ByteReader in(chunk.body);
  if (Status s = read_header(in, "attr", body); !s.ok()) return s;
  const size_t channels = chunk.header.in_groups() ? 0 : chunk.header.coded_channels();
  if (body.channels.size() != channels)
    return Status::corrupt("attr: not a header for every channel");
  for (const ChannelHeader& c : body.channels) {
    if (Status s = check_channel(chunk.header.type, c); !s.ok()) return s;
    if (chunk.header.computed() && c.numbers != ChannelHeader::Numbers::kMultiples)
      return Status::corrupt("attr: corrections that are no multiples");
  }
  section = chunk.body.subspan(in.position());
  return {};
}

void store_integer(ValueType type, int64_t number, uint8_t* to) {
  const auto wide = static_cast<int32_t>(number);
  const auto narrow = static_cast<uint16_t>(number);
  const auto byte = static_cast<uint8_t>(number);
  if (size_of(type) == sizeof wide) std::memcpy(to, &wide, sizeof wide);
  if (size_of(type) == sizeof narrow) std::memcpy(to, &narrow, sizeof narrow);
  if (size_of(type) == sizeof byte) *to = byte;
}

std::vector<uint8_t> spread_values(std::vector<uint8_t> of_sites,
                                   const std::vector<uint32_t>& of_element, size_t bytes) {
  if (of_element.empty()) return of_sites;
  std::vector<uint8_t> out(of_element.size() * bytes);
  for (size_t i = 0; i < of_element.size(); ++i)
    std::memcpy(&out[i * bytes], &of_sites[of_element[i] * bytes], bytes);
  return out;
}

std::vector<int32_t> output_grid(std::span<const int32_t> grid, std::span<const uint32_t> coding,
                                 std::span<const uint32_t> output) {
  std::vector<int32_t> out(grid.size());
  for (size_t i = 0; i < output.size(); ++i) {
    for (size_t axis = 0; axis < 3; ++axis)
      out[size_t{output[i]} * 3 + axis] = grid[size_t{coding[i]} * 3 + axis];
  }
  return out;
}

uint64_t element_count(Domain domain, const Connectivity& c) {
  switch (domain) {
    case Domain::kVertex:
      return c.vertex_count;
    case Domain::kCorner:
      return c.corners.size();
    case Domain::kFace:
      return c.face_sizes.size();
    case Domain::kShot:
      break;
  }
  return 1;
}

uint64_t attribute_bytes(const AttributeHeader& h, const Connectivity& c) {
  return element_count(h.domain, c) * h.channel_count * size_of(h.type);
}

uint64_t attribute_memory(const AttributeHeader& h, const Connectivity& c) {
  constexpr uint64_t kPerCorner = 160;  // triangles, the walk along them, edges and seams
  constexpr uint64_t kPerSite = 64;
  constexpr uint64_t kPerNumber = 4 + 16 + 4;  // integers, exceptions, numbers of sites
  constexpr uint64_t kModels = uint64_t{1} << 20;
  const uint64_t sites = element_count(h.domain, c);
  return kModels + (c.corners.size() + c.vertex_count) * kPerCorner + sites * kPerSite +
         sites * h.channel_count * kPerNumber + attribute_bytes(h, c);
}

Status describe_attribute(const AttributeChunk& chunk, Attribute& out) {
  AttributeBody body;
  std::span<const uint8_t> section;
  if (Status s = read_attribute_body(chunk, body, section); !s.ok()) return s;
  const AttributeHeader& h = chunk.header;
  out = {};
  out.name = h.name;
  out.semantic = h.semantic;
  out.domain = h.domain;
  out.type = h.type;
  out.channel_count = h.channel_count;
  out.animated = h.animated();
  for (NameEntry& n : body.names) out.names.push_back(std::move(n.name));
  return {};
}

Status decode_static_attribute(const AttributeChunk& chunk, const ShotSurface& surface,
                               const StopToken& stop, Attribute& out) {
  if (Status s = describe_attribute(chunk, out); !s.ok()) return s;
  const AttributeHeader& h = chunk.header;
  AttributeBody body;
  std::span<const uint8_t> section;
  if (Status s = read_attribute_body(chunk, body, section); !s.ok()) return s;
  StoppableDecoder coder(section, stop);
  Sites sites;
  if (!is_category(h, body))
    sites = code_sites(coder, h.domain, surface, [](uint32_t, uint32_t) { return false; });
  std::vector<uint32_t> integers;
  if (Status s = code_integers(coder, h, body, surface, sites.mesh, integers); !s.ok()) return s;
  std::vector<NumberException> exceptions;
  if (h.type == ValueType::kBinary32) {
    if (Status s = code_exceptions(coder, integers.size(), exceptions); !s.ok()) return s;
  }
  if (coder.overrun()) return Status::corrupt("the values of an attribute are cut off");
  out.values =
      spread_values(numbers(h, body, integers, exceptions), sites.of_element, out.element_bytes());
  return {};
}

}  // namespace reeb
