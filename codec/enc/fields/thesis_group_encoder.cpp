#include "codec/enc/fields/thesis_group_encoder.h"

#include <cmath>

#include "codec/enc/fields/field_encoder.h"
#include "codec/enc/search/laplace_source.h"

namespace reeb {

namespace {

/// Slope of distortion against rate of a uniform quantizer at high rate: D = step^2 / 12, one bit
/// halves the step.
double slope_at(double step) { return step * step * std::log(2.0) / 6; }

}  // namespace

RatePoint ThesisGroupEncoder::expect(const SurfaceContext&, const GroupSettings& settings) {
  const double q = settings.q;
  const auto values = static_cast<double>(signal_.trajectories.size());
  const double scale = std::sqrt(signal_.energy / values / 2);
  const RatePoint point = quantized_laplace_source(scale, q);
  return {values * point.bits, std::min(signal_.energy, values * q * q / 12)};
}

Eigen::MatrixXf ThesisGroupEncoder::motion_targets(const SurfaceContext& surface) {
  Eigen::MatrixXf out(surface.rows(), signal_.trajectories.cols());
  for (Eigen::Index c = 0; c < out.cols(); ++c) {
    const double offset = signal_.mean[c] - static_cast<double>(surface.header.origin[c % 3]);
    for (uint32_t row = 0; row < surface.rows(); ++row) {
      out(row, c) = static_cast<float>(
          static_cast<double>(signal_.trajectories(surface.input[row], c)) + offset);
    }
  }
  return out;
}

void ThesisGroupEncoder::choose_steps(const Eigen::MatrixXf& targets, const MotionFit* motion,
                                      CodedGroup& out) const {
  double spread[3] = {0, 0, 0};  // mean absolute residual of each coordinate
  MotionModel model;
  if (motion != nullptr)
    model = motion->quantize(out.axis_step, static_cast<uint32_t>(targets.cols()));
  for (Eigen::Index c = 0; c < targets.cols(); ++c) {
    Eigen::ArrayXf residual = targets.col(c).array();
    if (motion != nullptr) {
      const std::vector<float> moved = model.predict(static_cast<uint32_t>(c));
      residual -=
          out.axis_step[c % 3] * Eigen::Map<const Eigen::ArrayXf>(moved.data(), residual.size());
    }
    spread[c % 3] += residual.abs().cast<double>().sum();
  }
  const double count = static_cast<double>(targets.size()) / 3;
  for (int a = 0; a < 3; ++a) {
    out.axis_step[a] = static_cast<float>(laplace_source_step(spread[a] / count, slope_at(out.q)));
  }
}

CodedGroup ThesisGroupEncoder::encode(const SurfaceContext& surface, const GroupSettings& settings,
                                      const MotionFit* motion, GroupRun&) {
  CodedGroup out;
  for (float& step : out.axis_step) step = static_cast<float>(settings.q);
  out.q = static_cast<double>(out.axis_step[0]);
  const Eigen::MatrixXf targets = motion_targets(surface);
  choose_steps(targets, motion, out);
  out.component_count = static_cast<uint32_t>(targets.cols());
  MotionModel model;
  if (motion != nullptr) model = motion->quantize(out.axis_step, out.component_count);

  Field field(surface.surface.graph, unpredicted_field_options(), threads_);
  FieldEncoder encoder(field, surface.surface.graph, 0, 0);
  std::vector<float> target(surface.rows());
  for (uint32_t k = 0; k < out.component_count; ++k) {
    const float step = out.axis_step[k % 3];
    for (uint32_t row = 0; row < target.size(); ++row) target[row] = targets(row, k) / step;
    if (motion != nullptr) {
      const std::vector<float> moved = model.predict(k);
      for (uint32_t row = 0; row < target.size(); ++row) target[row] -= moved[row];
    }
    out.squared_error +=
        std::pow(static_cast<double>(step), 2) * encoder.code_component(target.data());
  }
  out.coefficients = encoder.recorder().encode(encoder.recorder().size());
  Planes planes = field.take_planes();
  if (motion != nullptr) encode_motion(surface, model, MotionModel::kFrameStride, out, planes);
  out.synthesis =
      GroupSynthesis(std::move(planes), out.axis_step, surface.header.origin, surface.input);
  return out;
}

}  // namespace reeb
