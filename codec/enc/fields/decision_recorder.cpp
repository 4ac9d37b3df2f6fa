#include "codec/enc/fields/decision_recorder.h"

#include <array>
#include <cmath>

namespace reeb {

double cost_of(Probability p) {
  static const std::array<float, 4096> table = [] {
    std::array<float, 4096> t{};
    for (int i = 0; i < 4096; ++i) t[i] = static_cast<float>(-std::log2((i + 0.5) / 4096.0));
    return t;
  }();
  return static_cast<double>(table[p >> 4]);
}

std::vector<uint8_t> DecisionRecorder::encode(size_t count) const {
  BinaryEncoder encoder;
  for (size_t i = 0; i < count; ++i) {
    encoder.code((decisions_[i] & 1) != 0, static_cast<Probability>(decisions_[i] >> 1));
  }
  return encoder.finish();
}

}  // namespace reeb
