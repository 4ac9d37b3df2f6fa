// What coding a group comes to at a quantization step, before it is coded: the residuals of some
// rows, predicted from original values, stand for all of them as Laplace sources.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "codec/enc/fields/karhunen_loeve.h"
#include "codec/enc/reference/surface_context.h"
#include "codec/enc/search/laplace_source.h"

namespace reeb {

struct RateModelOptions {
  double lambda = 0.1;         ///< of the encoder of the coefficients
  double mass_exponent = 0.7;  ///< of the same
  double residual_share = 1;   ///< what learning leaves of the residuals of the reference's weights
  double rate_share = 1;       ///< what contexts leave of the bits of independent sources
};

class RateModel {
 public:
  /// The group has `frames` frames. `transform`, whose coefficients are computed as far as they are
  /// needed, must outlive the model.
  RateModel(const SurfaceContext& surface, KarhunenLoeve& transform, uint32_t frames,
            const RateModelOptions& options);

  /// Bits of coefficients and basis, and the squared error of all positions, world units squared,
  /// at step q > 0: where `held` components are sent, or as many as pay.
  RatePoint at(double q, std::optional<uint32_t> held);

 private:
  struct Sample {
    uint32_t vertex;
    std::array<uint32_t, kMaxNeighbours> neighbours;  ///< vertices of the input
    std::array<float, kMaxNeighbours> weights;
  };
  /// Rows of about the same place in the hierarchy that move about as much.
  struct Band {
    uint32_t activity = 0;
    double rows = 0;
    double step = 0;        ///< mean, relative to q
    double importance = 0;  ///< mean
    std::vector<Sample> samples;
  };
  void sort_samples(const SurfaceContext& surface);
  /// Mean absolute residual of component k in each band, world units.
  const std::vector<double>& scales(uint32_t k);
  RatePoint component(uint32_t k, double q);

  KarhunenLoeve& transform_;
  uint32_t vertices_;
  uint32_t frames_;
  RateModelOptions options_;
  std::vector<Band> bands_;
  std::vector<std::vector<double>> scales_;  ///< [component][band]
};

}  // namespace reeb
