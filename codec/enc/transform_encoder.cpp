#include "codec/enc/transform_encoder.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "codec/common/coding_tools.h"
#include "codec/enc/basis_refit.h"
#include "codec/enc/field_encoder.h"

namespace reeb {

namespace {

constexpr double kCoefficientLambda = 0.10;  ///< bits against squared error, in q^2
constexpr double kBasisLambda = 0.08;
constexpr uint32_t kMostMotionComponents =
    96;                             ///< later ones carry no affine motion worth its bits
constexpr double kLeastSent = 0.2;  ///< mean square of a component that is sent, in q^2, typically
constexpr double kErrorWhereSent = 0.04;  ///< its squared error, in q^2
constexpr uint32_t kPatience =
    8;  ///< components without gain after which the search for their number ends
constexpr double kMassExponent = 0.7;

/// Keeps the number of components with the lowest cost seen.
class StopRule {
 public:
  explicit StopRule(uint32_t frames) : basis_weight_(6.0 * frames) {}

  /// Adds a component: energy before, squared error after, bits spent (all in units of q). False:
  /// stop.
  bool add(double energy, double error, double bits) {
    ++count_;
    const double basis_bits = basis_weight_ * 0.5 * std::log2(1 + 6 * energy / basis_weight_);
    cost_ += error + basis_weight_ / 12 - energy + kCoefficientLambda * (bits + basis_bits);
    if (cost_ < best_cost_) {
      best_cost_ = cost_;
      best_count_ = count_;
    }
    return count_ - best_count_ < kPatience;
  }
  uint32_t best() const { return best_count_; }

 private:
  double basis_weight_;  ///< about twice the 3F values of a basis vector, whose bits are estimated
  double cost_ = 0;
  double best_cost_ = 0;
  uint32_t count_ = 0;
  uint32_t best_count_ = 0;
};

double energy_of(const std::vector<float>& values) {
  double sum = 0;
  for (const float x : values) sum += static_cast<double>(x) * static_cast<double>(x);
  return sum;
}

}  // namespace

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
  GroupState& state = run.state;
  if (!run.continues) {
    state = start_closed_group(surface.surface, surface.points(), profile_, threads_);
  }
  // Components that are coded and then dropped leave no trace in what the next group continues.
  std::unique_ptr<Field> copy;
  if (run.continued && !held_count_) copy = std::make_unique<Field>(*state.coefficients);
  Planes planes =
      encode_coefficients(surface, motion, copy != nullptr ? *copy : *state.coefficients, out);
  if (copy != nullptr) {
    decode_coefficients(out.coefficients, out.component_count, *state.coefficients);
  }
  if (run.continued) state.coefficients->next_group();
  if (motion != nullptr) {
    MotionModel model = motion->quantize(out.axis_step, out.component_count);
    encode_motion(surface, model, 0, out, planes);
  }
  encode_basis(surface, planes, state.basis_contexts, out);
  return out;
}

double TransformEncoder::expected_error(double q) const {
  const double unit = q * q * static_cast<double>(signal_.vertices());
  double error = 0;
  for (const double energy : transform_.energies()) {
    error += energy < kLeastSent * unit ? energy : kErrorWhereSent * unit;
  }
  return error;
}

Eigen::MatrixXf TransformEncoder::motion_targets(const SurfaceContext& surface) {
  const uint32_t components = std::min(kMostMotionComponents, transform_.size());
  Eigen::MatrixXf out(surface.rows(), components);
  for (uint32_t k = 0; k < components; ++k) {
    const float* c = transform_.coefficients(k);
    for (uint32_t row = 0; row < surface.rows(); ++row) out(row, k) = c[surface.input[row]];
  }
  return out;
}

GroupEncoder::Planes TransformEncoder::encode_coefficients(const SurfaceContext& surface,
                                                           const MotionFit* motion, Field& field,
                                                           CodedGroup& out) {
  const PredictionGraph& graph = surface.surface.graph;
  FieldEncoder encoder(field, graph, thrift_ * kCoefficientLambda, kMassExponent);
  StopRule stop(signal_.frames);
  MotionModel model;
  if (motion != nullptr) model = motion->quantize(out.axis_step, transform_.size());
  std::vector<size_t> ends{0};
  std::vector<float> target(graph.size());
  const uint32_t most = std::min(held_count_.value_or(transform_.size()), transform_.size());
  bool more = true;
  for (uint32_t k = 0; k < most && more; ++k) {
    const float* coefficients = transform_.coefficients(k);
    for (uint32_t r = 0; r < target.size(); ++r) {
      target[r] = static_cast<float>(static_cast<double>(coefficients[surface.input[r]]) / out.q);
    }
    const double energy = energy_of(target);
    if (motion != nullptr) {
      const std::vector<float> moved = model.predict(k);
      for (uint32_t r = 0; r < target.size(); ++r) target[r] -= moved[r];
    }
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
  Field field(temporal_.graph, basis_field_options(), threads_);
  std::swap(field.model(), contexts);
  FieldEncoder encoder(field, temporal_.graph, thrift_ * kBasisLambda, 0);
  std::vector<float> target(temporal_.order.size());
  const double mean_scale = std::sqrt(static_cast<double>(signal_.vertices())) / out.q;
  for (size_t r = 0; r < target.size(); ++r) {
    const uint32_t at = temporal_.order[r];
    target[r] = static_cast<float>(
        (signal_.mean[at] - static_cast<double>(surface.header.origin[at % 3])) * mean_scale);
  }
  encoder.code_component(target.data());
  for (uint32_t k = 0; k < planes.size(); ++k) {
    const double norm = plane_norm(planes[k]);
    for (size_t r = 0; r < target.size(); ++r) {
      target[r] = static_cast<float>(basis(temporal_.order[r], k) * norm);
    }
    encoder.code_component(target.data());
  }
  out.basis = encoder.recorder().encode(encoder.recorder().size());
  out.synthesis =
      synthesize(signal_.vertices(), planes, field, temporal_.order, out.q, surface.header.origin);
  std::swap(field.model(), contexts);
  out.squared_error = refit.squared_error(out.synthesis);
}

}  // namespace reeb
