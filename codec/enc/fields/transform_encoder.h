// What the group encoders of the main and the fast profile share: temporal Karhunen-Loeve basis,
// prediction along the surface.
#pragma once

#include <memory>
#include <vector>

#include "codec/enc/fields/group_encoder.h"
#include "codec/enc/fields/karhunen_loeve.h"
#include "codec/enc/search/rate_model.h"

namespace reeb {

class TransformEncoder : public GroupEncoder {
 public:
  CodedGroup encode(const SurfaceContext& surface, const GroupSettings& settings,
                    const MotionFit* motion, GroupRun& run) override;
  RatePoint expect(const SurfaceContext& surface, const GroupSettings& settings) override;
  Eigen::MatrixXf motion_targets(const SurfaceContext& surface) override;

 protected:
  static constexpr double kCoefficientLambda = 0.10;  ///< bits against squared error, in q^2
  static constexpr double kBasisLambda = 0.08;
  static constexpr double kMassExponent = 0.7;

  /// What learning and contexts of the profile leave, measured on ten sequences at errors of 1 to
  /// 0.01 %.
  struct Shares {
    double residual = 1, rate = 1;  ///< see RateModelOptions
  };
  TransformEncoder(GroupSignal signal, const Shares& shares, unsigned threads);

  /// Codes the coefficient section; returns its planes as decoded.
  virtual Planes encode_coefficients(const SurfaceContext& surface, const GroupSettings& settings,
                                     const MotionFit* motion, GroupRun& run, CodedGroup& out) = 0;
  /// Codes the planes of the basis field; returns them as decoded.
  virtual Planes code_basis(const Planes& targets, MagnitudeModel& contexts, CodedGroup& out) = 0;

  /// How many components are coded at most; as many as are sent, where their number is set.
  uint32_t most_components(const GroupSettings& settings) const;
  /// Component k of every row, in units of q.
  std::vector<float> component_targets(const SurfaceContext& surface, uint32_t k, double q);

  TemporalGraph temporal_;
  KarhunenLoeve transform_;
  unsigned threads_;

 private:
  void encode_basis(const SurfaceContext& surface, const Planes& planes, MagnitudeModel& contexts,
                    CodedGroup& out);

  Shares shares_;
  std::unique_ptr<RateModel> model_;  ///< of the first surface asked about
};

/// Sum of squares.
double energy_of(const std::vector<float>& values);
/// target -= moved.
void subtract(const std::vector<float>& moved, std::vector<float>& target);

}  // namespace reeb
