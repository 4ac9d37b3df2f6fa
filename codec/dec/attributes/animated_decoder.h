// Decoder of animated attributes: three channels at a time are coded as positions are, on the mesh
// of the attribute's sites.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/container.h"
#include "codec/common/attributes/attribute_syntax.h"
#include "codec/common/base/stop.h"
#include "codec/dec/group_decoder.h"

namespace reeb {

/// The sites of an animated attribute, ready to predict on.
struct AttributeSurface {
  DecodedSurface surface;
  std::vector<uint32_t> of_element;  ///< site of each corner; empty where elements are sites
};

/// Rows of the surface graph are put out at their sites; all start from 0.
AttributeSurface attribute_surface(Sites sites, const StopToken& stop = {});

/// Sites of an animated attribute, and of computed normals what turns them in all frames, [site][u,
/// v]; `chunk` is loaded.
Status decode_attribute_sites(const AttributeChunk& chunk, const ShotSurface& surface,
                              const StopToken& stop, Sites& out, std::vector<float>& corrections);
/// Bytes that takes at most.
uint64_t attribute_surface_memory(uint64_t elements);

/// An attribute in the frames of a group. Refers to the surface.
struct AttributeFrames {
  std::vector<GroupSynthesis> parts;
  std::vector<double> scales;
};

/// A group of an attribute as it is found, before any of it is decoded.
struct AttributeGroupParts {
  std::vector<double> scales;
  std::vector<GroupChunk> parts;

  /// Bytes that decoding takes at most, and those that stay.
  uint64_t memory(uint64_t sites) const;
  uint64_t kept(uint64_t sites) const;
};

/// `chunk` is loaded; spans of `out` point into it.
Status read_attribute_group(const AttributeHeader& header, const AttributeGroupChunk& chunk,
                            AttributeGroupParts& out);
Status decode_attribute_group(const AttributeGroupParts& parts, const AttributeSurface& surface,
                              unsigned threads, const StopToken& stop, AttributeFrames& out);

/// The numbers of all sites in frame t of the group.
std::vector<uint8_t> attribute_frame(const AttributeHeader& header, const AttributeSurface& surface,
                                     const AttributeFrames& frames, uint32_t t);

}  // namespace reeb
