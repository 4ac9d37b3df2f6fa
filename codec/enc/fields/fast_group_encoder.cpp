#include "codec/enc/fields/fast_group_encoder.h"

#include <algorithm>

#include "codec/enc/fields/stop_rule.h"

namespace reeb {

namespace {

/// Codes a field twice, the second time with the costs that the first leads to: `code(encoder)`
/// codes its blocks and returns how many components, the first ones, are sent. Writes them to
/// `section` and returns them as decoded. `start()`: the field before its first block.
template <class Start, class Code>
LaneField::Planes code_twice(const PredictionGraph& graph, Start start, double lambda,
                             double mass_exponent, Code code, std::vector<uint8_t>& section) {
  SymbolCosts costs = expected_costs();
  for (bool last = false;; last = true) {
    LaneField field = start();
    LaneFieldEncoder encoder(field, graph, lambda, mass_exponent, costs);
    const uint32_t sent = code(encoder);
    const RansEncoder coded = encoder.section(sent);
    if (last) {
      section = coded.finish();
      LaneField::Planes planes = encoder.planes();
      planes.resize(sent);
      return planes;
    }
    costs = costs_of(coded.tables());
  }
}

}  // namespace

GroupEncoder::Planes FastGroupEncoder::encode_coefficients(const SurfaceContext& surface,
                                                           const GroupSettings& settings,
                                                           const MotionFit* motion,
                                                           GroupRun& /*run*/, CodedGroup& out) {
  const uint32_t most = most_components(settings);
  MotionModel model;
  if (motion != nullptr) model = motion->quantize(out.axis_step, transform_.size());
  const auto code = [&](LaneFieldEncoder& encoder) {
    StopRule stop(signal_.vertices(), signal_.frames, kCoefficientLambda);
    bool more = true;
    for (uint32_t k = 0, lanes = 0; k < most && more && !settings.stop.requested(); k += lanes) {
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
        more = stop.add(energy[l], coded[l].error, coded[l].bits) || settings.components;
    }
    return settings.components ? most : stop.best();
  };
  const PredictionGraph& graph = surface.surface.graph;
  Planes planes = code_twice(
      graph, [&] { return LaneField(graph, surface.surface.lanes(), settings.weak_prior); },
      kCoefficientLambda, kMassExponent, code, out.coefficients);
  out.component_count = static_cast<uint32_t>(planes.size());
  out.weak_prior = settings.weak_prior;
  return planes;
}

GroupEncoder::Planes FastGroupEncoder::code_basis(const Planes& targets,
                                                  MagnitudeModel& /*contexts*/, CodedGroup& out) {
  const auto count = static_cast<uint32_t>(targets.size());
  const auto code = [&](LaneFieldEncoder& encoder) {
    for (uint32_t k = 0, lanes = 0; k < count; k += lanes) {
      lanes = lanes_of_block(k, count);
      encoder.code_block({targets.begin() + k, targets.begin() + k + lanes});
    }
    return count;
  };
  const std::vector<float> weights = prior_weights(temporal_.graph);
  return code_twice(
      temporal_.graph, [&] { return LaneField(temporal_.graph, weights); }, kBasisLambda, 0, code,
      out.basis);
}

}  // namespace reeb
