#include "codec/common/lossless/difference_history.h"

#include "codec/common/base/integer_math.h"

namespace reeb {

namespace {

constexpr int32_t kUsualSize = 8 * 140;  // expected before anything is known

}  // namespace

DifferenceHistory::DifferenceHistory(const PredictionGraph& graph)
    : graph_(graph), traces_(graph.size()) {
  for (Trace& t : traces_) {
    t.size.fill(kUsualSize);
    t.older.fill(kUsualSize);
  }
  running_.fill(kUsualSize * kRunning);
  for (uint32_t row = 0; row < graph.size(); ++row) {
    const uint32_t octaves = log2_q5(std::max(1u, graph.size() / (row + 1))) / 32;
    coarseness_.push_back(static_cast<uint8_t>(std::min(7u, octaves)));
  }
}

}  // namespace reeb
