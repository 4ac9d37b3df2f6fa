#include "conformance/rd/peers/pca_coder.h"

namespace reeb::conformance {

double PcaCoder::predict(SurfacePrediction prediction, uint32_t i,
                         const std::vector<double>& values) const {
  if (prediction == SurfacePrediction::kNone) return 0;
  const uint32_t begin = traversal_.parallelogram_begin[i];
  const uint32_t end = traversal_.parallelogram_begin[i + 1];
  double sum = 0;
  if (prediction == SurfacePrediction::kParallelogram && begin < end) {
    for (uint32_t p = begin; p < end; ++p) {
      const auto& [a, b, c] = traversal_.parallelograms[p];
      sum += values[a] + values[b] - values[c];
    }
    return sum / (end - begin);
  }
  const uint32_t first = traversal_.neighbour_begin[i];
  const uint32_t last = traversal_.neighbour_begin[i + 1];
  for (uint32_t n = first; n < last; ++n) sum += values[traversal_.neighbours[n]];
  return first < last ? sum / (last - first) : 0;
}

double PcaCoder::extrapolate(uint32_t order, size_t i, const std::vector<double>& values) {
  if (order == 0 || i < 3) return 0;
  if (order == 1 || i < 6) return values[i - 3];
  return 2 * values[i - 3] - values[i - 6];
}

uint32_t PcaCoder::expected(uint32_t i, const std::vector<int32_t>& residual,
                            uint32_t running) const {
  const uint32_t first = traversal_.neighbour_begin[i];
  const uint32_t last = traversal_.neighbour_begin[i + 1];
  if (first == last) return running;
  uint64_t sum = 0;
  for (uint32_t n = first; n < last; ++n) sum += magnitude(residual[traversal_.neighbours[n]]);
  return static_cast<uint32_t>(4 * sum / (last - first));
}

}  // namespace reeb::conformance
