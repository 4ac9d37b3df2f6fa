#include "codec/common/magnitude_model.h"

#include <algorithm>

#include "codec/common/coding_tools.h"
#include "codec/common/integer_math.h"

namespace reeb {

namespace {

// Sizes of the context tables in entries of kBins decisions each; see `context` for what they hold.
constexpr std::array<uint32_t, MagnitudeModel::kTables> kEntries = {
    16 * 16, 32, 16 * 12, 12 * 8, 24 * 8, 32 * 10, 16 * 16, 16 * 16};
constexpr uint32_t kWeightClasses = 6;
constexpr uint32_t kAdaptationLimit = 100;

constexpr std::array<uint32_t, MagnitudeModel::kTables> table_sizes() {
  std::array<uint32_t, MagnitudeModel::kTables> sizes{};
  for (int i = 0; i < MagnitudeModel::kTables; ++i) sizes[i] = kEntries[i] * MagnitudeModel::kBins;
  return sizes;
}

/// Logarithmic class of a magnitude x (in 1/256): floor(scale / 4 * log2(1 + 4 x)), below
/// `classes`.
uint32_t log_class(uint32_t x, uint32_t classes, uint32_t scale) {
  const uint32_t logarithm = log2_q5(256 + 4 * uint64_t{x}) - 8 * 32;
  return std::min(classes - 1, logarithm * scale / 128);
}

}  // namespace

MagnitudeModel::MagnitudeModel()
    : mixer_(table_sizes(), kBins * kWeightClasses, kAdaptationLimit) {}

MagnitudeModel::Context MagnitudeModel::context(const Surroundings& s) {
  const uint32_t near = (2 * s.ring_mean + s.history + s.recent) / 4;
  const uint32_t all = static_cast<uint32_t>(
      (3 * uint64_t{s.ring_mean} + 2 * uint64_t{s.extra_mean} + 4 * uint64_t{s.recent} +
       uint64_t{s.running} + 5 * uint64_t{s.history} + 3 * uint64_t{s.ring_history}) /
      18);
  Context c;
  c.base[0] = log_class(s.ring_mean, 16, 8) * 16 + log_class(s.history, 16, 8);
  c.base[1] = log_class(near, 32, 12);
  c.base[2] = log_class(s.ring_history, 16, 8) * 12 + log_class(s.running, 12, 6);
  c.base[3] = log_class(s.ring_max, 12, 6) * 8 + s.level;
  c.base[4] = log_class(all, 24, 10) * 8 + s.level;
  c.base[5] = std::min(31u, s.component) * 10 + log_class(all, 10, 5);
  c.base[6] = log_class(s.recent, 16, 8) * 16 + log_class(s.last, 16, 8);
  c.base[7] = log_class(s.extra_mean, 16, 8) * 16 + log_class((s.ring_mean + s.recent) / 2, 16, 8);
  c.weight_set = log_class(all, kWeightClasses, 5);
  c.escape = log_class(near, kEscapeClasses, 3);
  return c;
}

MagnitudeModel::Mixer::Prediction MagnitudeModel::predict(const Context& c, uint32_t bin) const {
  std::array<uint32_t, kTables> entries;
  for (int i = 0; i < kTables; ++i) entries[i] = c.base[i] * kBins + bin;
  Mixer::Prediction made = mixer_.predict(entries, bin * kWeightClasses + c.weight_set);
  if (!uses(coding_tool::kMixing)) made.p1 = squash(made.input[0]);
  return made;
}

}  // namespace reeb
