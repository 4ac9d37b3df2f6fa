// Group encoder of the main and the fast profile: temporal Karhunen-Loeve basis, prediction along
// the surface.
#pragma once

#include <memory>
#include <vector>

#include "codec/enc/fields/group_encoder.h"
#include "codec/enc/fields/karhunen_loeve.h"
#include "codec/enc/search/rate_model.h"

namespace reeb {

class TransformEncoder : public GroupEncoder {
 public:
  TransformEncoder(GroupSignal signal, Profile profile, unsigned threads);

  CodedGroup encode(const SurfaceContext& surface, double q, const MotionFit* motion,
                    GroupRun& run) override;
  RatePoint expect(const SurfaceContext& surface, double q) override;
  Eigen::MatrixXf motion_targets(const SurfaceContext& surface) override;

 protected:
  static constexpr double kCoefficientLambda = 0.10;  ///< bits against squared error, in q^2
  static constexpr double kBasisLambda = 0.08;
  static constexpr double kMassExponent = 0.7;

  virtual Planes encode_coefficients(const SurfaceContext& surface, const MotionFit* motion,
                                     GroupRun& run, CodedGroup& out);
  /// Codes the planes of the basis field; returns them as decoded.
  virtual Planes code_basis(const std::vector<std::vector<float>>& targets,
                            MagnitudeModel& contexts, CodedGroup& out);
  /// How many components are coded at most; as many as are sent, where their number is held.
  uint32_t most_components() const;
  /// Component k of every row, in units of q.
  std::vector<float> component_targets(const SurfaceContext& surface, uint32_t k, double q);

  TemporalGraph temporal_;
  KarhunenLoeve transform_;
  Profile profile_;
  unsigned threads_;

 private:
  std::unique_ptr<RateModel> model_;  ///< of the first surface asked about

  Planes encode_field(const SurfaceContext& surface, const MotionFit* motion, Field& field,
                      CodedGroup& out);
  void encode_basis(const SurfaceContext& surface, const Planes& planes, MagnitudeModel& contexts,
                    CodedGroup& out);
};

/// Sum of squares.
double energy_of(const std::vector<float>& values);
/// target -= moved.
void subtract(const std::vector<float>& moved, std::vector<float>& target);

}  // namespace reeb
