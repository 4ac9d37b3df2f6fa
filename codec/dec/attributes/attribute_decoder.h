// Decoder of attributes.
#pragma once

#include <cstdint>
#include <span>

#include "bitstream/container.h"
#include "bitstream/status.h"
#include "codec/common/attributes/site_mesh.h"
#include "codec/common/base/attributes.h"
#include "codec/common/base/stop.h"
#include "codec/common/reference/reference_mesh.h"

namespace reeb {

/// Grid positions in output order: those of coding vertex `coding[i]` go to `output[i]`.
std::vector<int32_t> output_grid(std::span<const int32_t> grid, std::span<const uint32_t> coding,
                                 std::span<const uint32_t> output);

/// Elements of a domain.
uint64_t element_count(Domain domain, const Connectivity& connectivity);

/// Bytes that decoding an attribute takes at most, and those that its values take then.
uint64_t attribute_memory(const AttributeHeader& header, const Connectivity& connectivity);
uint64_t attribute_bytes(const AttributeHeader& header, const Connectivity& connectivity);

/// Body and section of a chunk that is loaded, the body checked against the header.
Status read_attribute_body(const AttributeChunk& chunk, AttributeBody& body,
                           std::span<const uint8_t>& section);

/// Writes a number within the range of an integer type.
void store_integer(ValueType type, int64_t number, uint8_t* to);

/// From sites to elements of `bytes` bytes; `of_element` empty: they are the same.
std::vector<uint8_t> spread_values(std::vector<uint8_t> of_sites,
                                   const std::vector<uint32_t>& of_element, size_t bytes);

/// What an attribute is, without values. `chunk` is loaded.
Status describe_attribute(const AttributeChunk& chunk, Attribute& out);

/// Decodes a static attribute; the body may be anything.
Status decode_static_attribute(const AttributeChunk& chunk, const ShotSurface& surface,
                               const StopToken& stop, Attribute& out);

}  // namespace reeb
