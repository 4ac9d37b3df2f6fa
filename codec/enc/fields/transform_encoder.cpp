#include "codec/enc/fields/transform_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/common/base/coding_tools.h"
#include "codec/enc/fields/basis_refit.h"

namespace reeb {

namespace {

constexpr uint32_t kMaxMotionComponents = 96;  ///< later ones carry no affine motion worth its bits

}  // namespace

double energy_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float x : values) sum += static_cast<double>(x) * static_cast<double>(x);
  return sum;
}

void subtract(const std::vector<float>& moved, std::vector<float>& target) {
  for (size_t r = 0; r < target.size(); ++r) target[r] -= moved[r];
}

std::vector<float> TransformEncoder::component_targets(const SurfaceContext& surface, uint32_t k,
                                                       double q) {
  const float* coefficients = transform_.coefficients(k);
  std::vector<float> out(surface.rows());
  for (uint32_t r = 0; r < out.size(); ++r)
    out[r] = static_cast<float>(static_cast<double>(coefficients[surface.input[r]]) / q);
  return out;
}

uint32_t TransformEncoder::most_components(const GroupSettings& settings) const {
  return std::min(settings.components.value_or(transform_.size()), transform_.size());
}

TransformEncoder::TransformEncoder(GroupSignal signal, const Shares& shares, unsigned threads)
    : GroupEncoder(std::move(signal)),
      temporal_(build_temporal_graph(signal_.frames)),
      transform_(signal_),
      threads_(threads),
      shares_(shares) {}

CodedGroup TransformEncoder::encode(const SurfaceContext& surface, const GroupSettings& settings,
                                    const MotionFit* motion, GroupRun& run) {
  CodedGroup out;
  const auto step = static_cast<float>(settings.q);  // as the header keeps it
  out.q = static_cast<double>(step);
  std::fill(std::begin(out.axis_step), std::end(out.axis_step), step);
  Planes planes = encode_coefficients(surface, settings, motion, run, out);
  if (motion != nullptr) {
    MotionModel model = motion->quantize(out.axis_step, out.component_count);
    encode_motion(surface, model, 0, out, planes);
  }
  encode_basis(surface, planes, run.state.basis_contexts, out);
  return out;
}

RatePoint TransformEncoder::expect(const SurfaceContext& surface, const GroupSettings& settings) {
  if (model_ == nullptr) {
    const RateModelOptions options = {.lambda = kCoefficientLambda,
                                      .mass_exponent = kMassExponent,
                                      .residual_share = shares_.residual,
                                      .rate_share = shares_.rate};
    model_ = std::make_unique<RateModel>(surface, transform_, signal_.frames, options);
  }
  return model_->at(settings.q, settings.components);
}

Eigen::MatrixXf TransformEncoder::motion_targets(const SurfaceContext& surface) {
  const uint32_t components = std::min(kMaxMotionComponents, transform_.size());
  Eigen::MatrixXf out(surface.rows(), components);
  for (uint32_t k = 0; k < components; ++k) {
    const float* c = transform_.coefficients(k);
    for (uint32_t row = 0; row < surface.rows(); ++row) out(row, k) = c[surface.input[row]];
  }
  return out;
}

void TransformEncoder::encode_basis(const SurfaceContext& surface, const Planes& planes,
                                    MagnitudeModel& contexts, CodedGroup& out) {
  const BasisRefit refit(signal_, transform_.basis(), planes, surface.row_of, out.q);
  const Eigen::MatrixXd& basis =
      uses(coding_tool::kBasisRefit) ? refit.basis() : transform_.basis();
  std::vector<std::vector<float>> targets(planes.size() + 1,
                                          std::vector<float>(temporal_.order.size()));
  const double mean_scale = std::sqrt(static_cast<double>(signal_.vertices())) / out.q;
  for (size_t r = 0; r < temporal_.order.size(); ++r) {
    const uint32_t at = temporal_.order[r];
    targets[0][r] = static_cast<float>(
        (signal_.mean[at] - static_cast<double>(surface.header.origin[at % 3])) * mean_scale);
  }
  const std::vector<double> norms = plane_norms(planes);
  for (uint32_t k = 0; k < planes.size(); ++k) {
    for (size_t r = 0; r < temporal_.order.size(); ++r)
      targets[k + 1][r] = static_cast<float>(basis(temporal_.order[r], k) * norms[k]);
  }
  const Planes coded = code_basis(targets, contexts, out);
  out.synthesis =
      synthesize(planes, coded, temporal_.order, out.q, surface.header.origin, surface.input);
  out.squared_error = refit.squared_error(out.synthesis);
}

}  // namespace reeb
