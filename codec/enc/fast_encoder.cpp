#include "codec/enc/fast_encoder.h"

#include <algorithm>

#include "codec/enc/stop_rule.h"

namespace reeb {

namespace {

constexpr uint32_t kPasses = 2;  ///< the second with the costs that the first leads to

}  // namespace

GroupEncoder::Planes FastEncoder::encode_coefficients(const SurfaceContext& surface,
                                                      const MotionFit* motion, GroupRun& /*run*/,
                                                      CodedGroup& out) {
  const PredictionGraph& graph = surface.surface.graph;
  SymbolCosts costs = expected_costs();
  const uint32_t most = most_components();
  Planes planes;
  for (uint32_t pass = 0; pass < kPasses; ++pass) {
    LaneField field(graph, surface.weights, {});
    LaneFieldEncoder encoder(field, graph, kCoefficientLambda, kMassExponent, costs);
    StopRule stop(signal_.frames, kCoefficientLambda);
    MotionModel model;
    if (motion != nullptr) model = motion->quantize(out.axis_step, transform_.size());
    bool more = true;
    for (uint32_t k = 0, lanes = 0; k < most && more; k += lanes) {
      lanes = lanes_of_block(k, most);
      std::vector<std::vector<float>> targets;
      std::vector<double> energy;
      for (uint32_t l = 0; l < lanes; ++l) {
        targets.push_back(component_targets(surface, k + l, out.q));
        energy.push_back(energy_of(targets.back()));
        if (motion != nullptr) subtract(model.predict(k + l), targets.back());
      }
      const std::vector<CodedComponent> coded = encoder.code_block(targets);
      for (uint32_t l = 0; l < lanes && more; ++l)
        more = stop.add(energy[l], coded[l].error, coded[l].bits) || held_count_;
    }
    out.component_count = held_count_ ? most : stop.best();
    const RansEncoder section = encoder.section(out.component_count);
    if (pass + 1 < kPasses) {
      costs = costs_of(section.tables());
      continue;
    }
    out.coefficients = section.finish();
    planes = encoder.planes();
    planes.resize(out.component_count);
  }
  return planes;
}

GroupEncoder::Planes FastEncoder::code_basis(const std::vector<std::vector<float>>& targets,
                                             MagnitudeModel& /*contexts*/, CodedGroup& out) {
  const PredictionGraph& graph = temporal_.graph;
  const std::vector<float> weights = prior_weights(graph);
  SymbolCosts costs = expected_costs();
  Planes planes;
  for (uint32_t pass = 0; pass < kPasses; ++pass) {
    LaneField field(graph, weights, {});
    LaneFieldEncoder encoder(field, graph, kBasisLambda, 0, costs);
    const auto count = static_cast<uint32_t>(targets.size());
    for (uint32_t k = 0, lanes = 0; k < count; k += lanes) {
      lanes = lanes_of_block(k, count);
      encoder.code_block({targets.begin() + k, targets.begin() + k + lanes});
    }
    const RansEncoder section = encoder.section(count);
    if (pass + 1 < kPasses) {
      costs = costs_of(section.tables());
      continue;
    }
    out.basis = section.finish();
    planes = encoder.planes();
  }
  return planes;
}

}  // namespace reeb
