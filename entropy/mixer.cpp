#include "entropy/mixer.h"

#include "entropy/table.h"

namespace reeb {

namespace {

constexpr int kSquashSize = 2 * kSquashLimit + 1;

// exp(1/256) to the last bit of binary64; powers of it stay within 1e-12 of exact, far closer than
// any table value lies to a rounding tie (a test checks every entry).
constexpr double kStepRatio = 1.0039138893383475734;

REEB_TABLE_MAKER std::array<Probability, kSquashSize> make_squash() {
  std::array<Probability, kSquashSize> table{};
  double e = 1.0;  // exp(x / 256)
  for (int x = 0; x <= kSquashLimit; ++x, e *= kStepRatio) {
    const double upper = 65536.0 * (e / (1.0 + e));
    const auto rounded = static_cast<uint32_t>(upper + 0.5);
    const uint32_t p = rounded > 65535 ? 65535 : rounded;
    table[kSquashLimit + x] = static_cast<Probability>(p);
    table[kSquashLimit - x] = static_cast<Probability>(65536 - p);
  }
  return table;
}

REEB_TABLE_MAKER std::array<int16_t, 4096> make_stretch() {
  REEB_TABLE auto squash = make_squash();
  std::array<int16_t, 4096> table{};
  int x = -kStretchLimit;
  for (int i = 0; i < 4096; ++i) {
    const int p = i * 16 + 8;
    while (x < kStretchLimit && squash[x + kSquashLimit] < p) ++x;
    table[i] = static_cast<int16_t>(x);
  }
  return table;
}

}  // namespace

namespace detail {
REEB_TABLE std::array<Probability, 2 * kSquashLimit + 1> kSquash = make_squash();
REEB_TABLE std::array<int16_t, 4096> kStretch = make_stretch();
}  // namespace detail

}  // namespace reeb
