#include "codec/enc/fields/transform_encoder.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "codec/common/base/coding_tools.h"
#include "codec/enc/fields/basis_refit.h"
#include "codec/enc/fields/field_encoder.h"
#include "codec/enc/fields/stop_rule.h"

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

uint32_t TransformEncoder::most_components() const {
  return std::min(held_count_.value_or(transform_.size()), transform_.size());
}

TransformEncoder::TransformEncoder(GroupSignal signal, Profile profile, unsigned threads)
    : GroupEncoder(std::move(signal)),
      temporal_(build_temporal_graph(signal_.frames)),
      transform_(signal_),
      profile_(profile),
      threads_(threads) {}

CodedGroup TransformEncoder::encode(const SurfaceContext& surface, double q,
                                    const MotionFit* motion, GroupRun& run) {
  CodedGroup out;
  out.q = static_cast<double>(static_cast<float>(q));  // as the header keeps it
  std::fill(std::begin(out.axis_step), std::end(out.axis_step), static_cast<float>(q));
  Planes planes = encode_coefficients(surface, motion, run, out);
  if (motion != nullptr) {
    MotionModel model = motion->quantize(out.axis_step, out.component_count);
    encode_motion(surface, model, 0, out, planes);
  }
  encode_basis(surface, planes, run.state.basis_contexts, out);
  return out;
}

RatePoint TransformEncoder::expect(const SurfaceContext& surface, double q) {
  if (model_ == nullptr) {
    // Shares as measured on ten sequences at errors of 1 to 0.01 %.
    const bool learns = profile_ == Profile::kMain;
    const RateModelOptions options = {.lambda = kCoefficientLambda,
                                      .mass_exponent = kMassExponent,
                                      .residual_share = learns ? 0.8 : 1.0,
                                      .rate_share = learns ? 0.55 : 0.8};
    model_ = std::make_unique<RateModel>(surface, transform_, signal_.frames, options);
  }
  return model_->at(q, held_count_);
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

GroupEncoder::Planes TransformEncoder::encode_coefficients(const SurfaceContext& surface,
                                                           const MotionFit* motion, GroupRun& run,
                                                           CodedGroup& out) {
  GroupState& state = run.state;
  if (!run.continues) {
    state = start_closed_group(surface.surface, surface.points(), profile_, weak_prior_, threads_);
    out.weak_prior = weak_prior_;
  }
  // Components that are coded and then dropped leave no trace in what the next group continues.
  std::unique_ptr<Field> copy;
  if (run.continued && !held_count_) copy = std::make_unique<Field>(*state.coefficients);
  Planes planes = encode_field(surface, motion, copy != nullptr ? *copy : *state.coefficients, out);
  if (copy != nullptr)
    decode_coefficients(out.coefficients, out.component_count, *state.coefficients);
  if (run.continued) state.coefficients->next_group();
  return planes;
}

GroupEncoder::Planes TransformEncoder::encode_field(const SurfaceContext& surface,
                                                    const MotionFit* motion, Field& field,
                                                    CodedGroup& out) {
  const PredictionGraph& graph = surface.surface.graph;
  FieldEncoder encoder(field, graph, kCoefficientLambda, kMassExponent);
  StopRule stop(signal_.frames, kCoefficientLambda);
  MotionModel model;
  if (motion != nullptr) model = motion->quantize(out.axis_step, transform_.size());
  std::vector<size_t> ends{0};
  const uint32_t most = most_components();
  bool more = true;
  for (uint32_t k = 0; k < most && more; ++k) {
    std::vector<float> target = component_targets(surface, k, out.q);
    const double energy = energy_of(target);
    if (motion != nullptr) subtract(model.predict(k), target);
    const double bits_before = encoder.recorder().bits();
    const double error = encoder.code_component(target.data());
    ends.push_back(encoder.recorder().size());
    more = stop.add(energy, error, encoder.recorder().bits() - bits_before) || held_count_;
  }
  out.component_count = held_count_ ? most : stop.best();
  out.coefficients = encoder.recorder().encode(ends[out.component_count]);
  Planes planes;
  for (uint32_t k = 0; k < out.component_count; ++k) planes.push_back(field.plane(k));
  return planes;
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

GroupEncoder::Planes TransformEncoder::code_basis(const std::vector<std::vector<float>>& targets,
                                                  MagnitudeModel& contexts, CodedGroup& out) {
  Field field(temporal_.graph, basis_field_options(), threads_);
  std::swap(field.model(), contexts);
  FieldEncoder encoder(field, temporal_.graph, kBasisLambda, 0);
  for (const std::vector<float>& target : targets) encoder.code_component(target.data());
  out.basis = encoder.recorder().encode(encoder.recorder().size());
  std::swap(field.model(), contexts);
  return field.take_planes();
}

}  // namespace reeb
