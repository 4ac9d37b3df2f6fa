#include "bitstream/element_bound.h"

namespace reeb {

namespace {

constexpr uint64_t kPerTransform = 12;  ///< coefficients of an affine map
constexpr uint64_t kPerCorrection = 8;  ///< each takes that much more memory than a value

}  // namespace

uint64_t section_bytes(const GroupHeader& h) {
  uint64_t sum = 0;
  for (const GroupSection& s : kGroupSections) sum += h.*s.bytes;
  return sum;
}

uint64_t group_elements(const GroupHeader& h, uint64_t vertices) {
  const uint64_t coordinates = 3 * uint64_t{h.frame_count};
  if (h.profile == Profile::kLossless)
    return vertices * (3 * uint64_t{h.stored_count} + 1) + coordinates;
  const uint64_t components = h.component_count;
  return vertices * (components + 1) + coordinates * (components + 1) +
         kPerTransform * h.region_count * components + kPerCorrection * h.correction_count;
}

bool within_element_bound(const GroupHeader& h, uint64_t vertices) {
  return group_elements(h, vertices) <= kElementsPerByte * (kGroupFrontBytes + section_bytes(h));
}

GroupSections within_element_bound(const GroupHeader& header, uint64_t vertices,
                                   GroupSections sections, std::vector<uint8_t>& padded) {
  uint64_t bytes = kGroupFrontBytes;
  for (const GroupSection& s : kGroupSections) bytes += (sections.*s.data).size();
  const uint64_t elements = group_elements(header, vertices);
  if (elements <= kElementsPerByte * bytes) return sections;
  const bool lossless = header.profile == Profile::kLossless;
  std::span<const uint8_t>& section = lossless ? sections.differences : sections.coefficients;
  uint64_t zeros = (elements + kElementsPerByte - 1) / kElementsPerByte - bytes;
  zeros += zeros % 2;  // the fast profile has words of two bytes
  padded.assign(section.begin(), section.end());
  padded.resize(padded.size() + zeros);
  section = padded;
  return sections;
}

}  // namespace reeb
