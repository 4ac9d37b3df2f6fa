// Encoder of animated attributes: three channels at a time as positions are, on the mesh of the
// attribute's sites.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/attribute_headers.h"
#include "bitstream/status.h"
#include "codec/common/attributes/attribute_syntax.h"
#include "codec/common/base/attributes.h"
#include "codec/enc/attributes/attribute_encoder.h"
#include "codec/enc/reference/surface_context.h"

namespace reeb {

/// How groups of attributes are coded.
struct AnimatedOptions {
  Profile profile = Profile::kMain;  ///< main or fast, where errors are allowed
  bool quick = false;                ///< lossless: the method that decodes quicker
  bool bounds = false;               ///< boxes of the groups are wanted, too
  bool reorder = false;              ///< the file has the vertices in another order
  int trials = 5;                    ///< of the step under corrections
  unsigned threads = 1;
};

class AnimatedEncoder {
 public:
  /// `attribute` is animated and in output order; it must outlive the encoder. Fills `coded` but
  /// for shot and index. kInvalidArgument where a number is not finite, or of 32 bits and beyond
  /// what binary32 has exactly.
  Status begin(const Attribute& attribute, const ShotSurface& surface, CodedAttribute& coded);
  /// The same on sites that are known, of `frame_elements` elements.
  void begin(const Attribute& attribute, size_t frame_elements, Sites sites);

  /// What follows the header of chunk `agrp`; `group`: shot, first frame in the sequence, count.
  /// `first_frame` is that in the shot.
  Status encode_group(const AttributeGroupHeader& group, uint32_t first_frame,
                      const AnimatedOptions& options, std::vector<uint8_t>& out) const;

 private:
  /// Coordinates of three channels, [frame][site][3].
  std::vector<float> gather(uint32_t part, const std::vector<double>& scales, uint32_t first_frame,
                            uint32_t frames) const;
  /// `exact`: no error is allowed; else it is 1.
  std::vector<uint8_t> encode_part(uint32_t part, uint32_t first_frame,
                                   const AttributeGroupHeader& group,
                                   const AnimatedOptions& options,
                                   std::vector<double>& scales) const;
  std::vector<uint8_t> encode_exactly(const std::vector<float>& coordinates, double step,
                                      const AttributeGroupHeader& group,
                                      const AnimatedOptions& options) const;
  std::vector<uint8_t> encode_roughly(const std::vector<float>& coordinates, double bound,
                                      const AttributeGroupHeader& group,
                                      const AnimatedOptions& options) const;

  const Attribute* attribute_ = nullptr;
  size_t frame_elements_ = 0;
  std::vector<size_t> elements_;  ///< of every site, one that has its values
  SurfaceContext surface_;
};

}  // namespace reeb
