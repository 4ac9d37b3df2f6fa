#include "codec/enc/attributes/normal_choice.h"

#include <cmath>
#include <numbers>

#include "codec/common/attributes/attribute_syntax.h"
#include "codec/dec/attributes/computed_normals.h"
#include "entropy/interval_coder.h"

namespace reeb {

namespace {

/// Angles between normals, compared with the largest that is allowed.
class AngleTest {
 public:
  explicit AngleTest(double degrees) : cosine_(std::cos(degrees * std::numbers::pi / 180)) {}

  bool within(const float* a, const float* b) const {
    double dot = 0, aa = 0, bb = 0;
    for (int i = 0; i < 3; ++i) {
      const auto x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
      dot += x * y;
      aa += x * x;
      bb += y * y;
    }
    return aa > 0 && bb > 0 ? dot >= cosine_ * std::sqrt(aa * bb) : aa == bb;
  }

 private:
  double cosine_;
};

}  // namespace

bool compute_normals(const Attribute& attribute, const ShotSurface& surface, uint32_t frame_count,
                     const FramePositions& positions, CodedAttribute& out) {
  out = {};
  out.header = header_of(attribute);
  if (!(attribute.max_angle > 0) || !out.header.may_be_computed()) return false;
  out.header.flags = AttributeHeader::kAnimated | AttributeHeader::kComputed;
  std::vector<float> normals(attribute.values.size() / sizeof(float));
  std::memcpy(normals.data(), attribute.values.data(), attribute.values.size());
  const uint32_t frames = attribute.animated ? frame_count : 1;
  const size_t frame_size = normals.size() / frames;
  const AngleTest test(attribute.max_angle);
  IntervalEncoder coder;
  const Sites sites = code_sites(coder, attribute.domain, surface, [&](uint32_t a, uint32_t b) {
    for (uint32_t t = 0; t < frames; ++t) {
      const float* frame = &normals[t * frame_size];
      if (!test.within(frame + 3 * size_t{a}, frame + 3 * size_t{b})) return true;
    }
    return false;
  });
  for (uint32_t t = 0; t < frames; ++t) {
    const std::vector<float> computed = computed_normals(sites.mesh, positions(t));
    for (size_t e = 0; e < frame_size / 3; ++e) {
      const float* wanted = &normals[t * frame_size + 3 * e];
      if (!test.within(&computed[size_t{3} * sites.site(e)], wanted)) return false;
    }
  }
  out.section = coder.finish();
  return true;
}

}  // namespace reeb
