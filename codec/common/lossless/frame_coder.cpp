#include "codec/common/lossless/frame_coder.h"

namespace reeb {

namespace {

constexpr DisplacementOptions kQuickPrediction = {.neighbours = 6, .period = 4};

}  // namespace

FrameCoder::FrameCoder(const PredictionGraph& graph, const std::vector<float>& start,
                       const NumberSets& sets, bool quick, unsigned threads)
    : graph_(graph),
      sets_(sets),
      predictor_(graph, start, quick ? kQuickPrediction : DisplacementOptions(), threads),
      history_(graph),
      quick_(quick) {}

}  // namespace reeb
