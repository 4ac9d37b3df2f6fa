#include "codec/common/lossless/frame_coder.h"

namespace reeb {

namespace {

constexpr DisplacementOptions kQuickPrediction = {.neighbours = 6, .period = 4};

}  // namespace

FrameCoder::FrameCoder(const PredictionGraph& graph, const std::vector<float>& start,
                       const NumberSets& sets, bool quick, unsigned threads, const StopToken& stop)
    : graph_(graph),
      stop_(stop),
      sets_(sets),
      by_frame_{sets[0].by_frame(), sets[1].by_frame(), sets[2].by_frame()},
      predictor_(graph, start, quick ? kQuickPrediction : DisplacementOptions(), threads, stop),
      history_(graph),
      quick_(quick) {}

}  // namespace reeb
