#include "codec/common/fields/magnitude_model.h"

#include <algorithm>

#include "codec/common/base/integer_math.h"

namespace reeb {

namespace {

/// Logarithmic class of a magnitude x (in 1/256): floor(scale / 4 * log2(1 + 4 x)), below
/// `classes`.
uint32_t log_class(uint32_t x, uint32_t classes, uint32_t scale) {
  const uint32_t logarithm = log2_q5(256 + 4 * uint64_t{x}) - 8 * 32;
  return std::min(classes - 1, logarithm * scale / 128);
}

std::array<uint32_t, MagnitudeModel::kTables> table_sizes(
    const std::array<uint32_t, MagnitudeModel::kTables>& contexts) {
  std::array<uint32_t, MagnitudeModel::kTables> sizes = contexts;
  for (uint32_t& size : sizes) size *= MagnitudeModel::kNodes;
  return sizes;
}

}  // namespace

MagnitudeModel::MagnitudeModel() : mixer_(table_sizes(kContexts), kNodes, kAdaptationLimit) {}

MagnitudeModel::Context MagnitudeModel::context(const Surroundings& s) {
  // (x << 16) / step, by a product where that is exact: x * inverse errs by less than 2^34 / step.
  const auto relative = [&s](uint64_t x) {
    if (x < 1u << 18) return static_cast<uint32_t>(x * s.inverse_step >> 34);
    return static_cast<uint32_t>((x << 16) / s.step);
  };
  const uint32_t ring = relative(s.ring_mean);
  const uint32_t recent = relative(s.recent);
  const uint32_t expected = relative(s.expected() / 16);
  const uint32_t by_expected = log_class(expected, 24, 8);
  const uint32_t by_ring = log_class(ring, 12, 6) * 12 + log_class(relative(s.history), 12, 6);
  const uint32_t by_recent = log_class(recent, 8, 4) * 12 + log_class(relative(s.last), 12, 6);
  const uint32_t by_rest =
      log_class(relative(s.extra_mean), 12, 6) * 12 + log_class((ring + recent) / 2, 12, 6);
  Context c;
  c.table = {by_ring * kNodes, by_expected * kNodes, by_recent * kNodes, by_rest * kNodes};
  c.escape = log_class(expected, kEscapeClasses, 3);
  c.unsure = by_expected >= kUnsureClass;
  return c;
}

}  // namespace reeb
