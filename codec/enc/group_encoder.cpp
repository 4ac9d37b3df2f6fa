#include "codec/enc/group_encoder.h"

#include <cmath>
#include <utility>

#include "codec/enc/basis_refit.h"
#include "codec/enc/field_encoder.h"

namespace reeb {

namespace {

constexpr double kCoefficientLambda = 0.10;  ///< bits against squared error, in q^2
constexpr double kBasisLambda = 0.08;
constexpr double kMassExponent = 0.7;
constexpr uint32_t kPatience =
    8;  ///< components without gain after which the search for their number ends

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

double energy_of(const float* values, uint32_t count, double scale) {
  double sum = 0;
  for (uint32_t i = 0; i < count; ++i) sum += std::pow(static_cast<double>(values[i]) * scale, 2);
  return sum;
}

}  // namespace

GroupEncoder::GroupEncoder(const SurfaceContext& surface, GroupSignal signal, bool fast_profile,
                           unsigned threads)
    : surface_(surface),
      signal_(std::move(signal)),
      temporal_(build_temporal_graph(signal_.frames)),
      transform_(signal_),
      fast_profile_(fast_profile),
      threads_(threads) {}

CodedGroup GroupEncoder::encode(double q) {
  CodedGroup out;
  out.q = static_cast<double>(static_cast<float>(q));  // as the header keeps it
  std::vector<std::vector<float>> planes = encode_coefficients(out.q, out);
  encode_basis(planes, out);
  return out;
}

std::vector<std::vector<float>> GroupEncoder::encode_coefficients(double q, CodedGroup& out) {
  const PredictionGraph& graph = surface_.surface.graph;
  Field field(graph, surface_field_options(fast_profile_), threads_);
  field.learn_reference(surface_.points, surface_.surface.order);
  FieldEncoder encoder(field, graph, kCoefficientLambda, kMassExponent);
  StopRule stop(signal_.frames);
  std::vector<size_t> ends{0};
  bool more = true;
  for (uint32_t k = 0; k < transform_.size() && more; ++k) {
    const float* target = transform_.coefficients(k);
    const double bits_before = encoder.recorder().bits();
    const double error = encoder.code_component(target, 1 / q);
    ends.push_back(encoder.recorder().size());
    more = stop.add(energy_of(target, graph.size(), 1 / q), error,
                    encoder.recorder().bits() - bits_before);
  }
  out.component_count = stop.best();
  out.coefficients = encoder.recorder().encode(ends[stop.best()]);
  std::vector<std::vector<float>> planes;
  for (uint32_t k = 0; k < stop.best(); ++k) planes.push_back(field.plane(k));
  return planes;
}

void GroupEncoder::encode_basis(const std::vector<std::vector<float>>& planes, CodedGroup& out) {
  const BasisRefit refit(signal_, transform_.basis(), planes, out.q);
  Field field(temporal_.graph, basis_field_options(), threads_);
  FieldEncoder encoder(field, temporal_.graph, kBasisLambda, 0);
  std::vector<float> target(temporal_.order.size());
  const double mean_scale = std::sqrt(static_cast<double>(signal_.vertices())) / out.q;
  for (size_t r = 0; r < target.size(); ++r) {
    target[r] = static_cast<float>(signal_.mean[temporal_.order[r]] * mean_scale);
  }
  encoder.code_component(target.data(), 1);
  for (uint32_t k = 0; k < planes.size(); ++k) {
    const double norm = plane_norm(planes[k]);
    for (size_t r = 0; r < target.size(); ++r) {
      target[r] = static_cast<float>(refit.basis()(temporal_.order[r], k) * norm);
    }
    encoder.code_component(target.data(), 1);
  }
  out.basis = encoder.recorder().encode(encoder.recorder().size());
  out.synthesis =
      synthesize(signal_.vertices(), planes, field, temporal_.order, out.q, surface_.origin);
  out.squared_error = refit.squared_error(out.synthesis, surface_.origin);
}

}  // namespace reeb
