#include "codec/enc/fields/main_group_encoder.h"

#include <memory>
#include <utility>

#include "codec/dec/field_decoder.h"
#include "codec/enc/fields/field_encoder.h"
#include "codec/enc/fields/stop_rule.h"

namespace reeb {

GroupEncoder::Planes MainGroupEncoder::encode_coefficients(const SurfaceContext& surface,
                                                           const GroupSettings& settings,
                                                           const MotionFit* motion, GroupRun& run,
                                                           CodedGroup& out) {
  GroupState& state = run.state;
  if (!run.continues) {
    state = start_closed_group(surface.surface, surface.surface.points(), settings.weak_prior,
                               threads_);
    out.weak_prior = settings.weak_prior;
  }
  // Components that are coded and then dropped leave no trace in what the next group continues.
  std::unique_ptr<Field> copy;
  if (run.continued && !settings.components) copy = std::make_unique<Field>(*state.coefficients);
  Field& field = copy != nullptr ? *copy : *state.coefficients;
  Planes planes = encode_field(surface, settings, motion, field, out);
  if (copy != nullptr) decode_field(out.coefficients, out.component_count, *state.coefficients);
  if (run.continued) state.coefficients->next_group();
  return planes;
}

GroupEncoder::Planes MainGroupEncoder::encode_field(const SurfaceContext& surface,
                                                    const GroupSettings& settings,
                                                    const MotionFit* motion, Field& field,
                                                    CodedGroup& out) {
  FieldEncoder encoder(field, surface.surface.graph, kCoefficientLambda, kMassExponent);
  StopRule stop(signal_.vertices(), signal_.frames, kCoefficientLambda);
  MotionModel model;
  if (motion != nullptr) model = motion->quantize(out.axis_step, transform_.size());
  std::vector<size_t> ends{0};
  const uint32_t most = most_components(settings);
  bool more = true;
  for (uint32_t k = 0; k < most && more && !settings.stop.requested(); ++k) {
    std::vector<float> target = component_targets(surface, k, out.q);
    const double energy = energy_of(target);
    if (motion != nullptr) subtract(model.predict(k), target);
    const double bits_before = encoder.recorder().bits();
    const double error = encoder.code_component(target.data());
    ends.push_back(encoder.recorder().size());
    more = stop.add(energy, error, encoder.recorder().bits() - bits_before) || settings.components;
  }
  out.component_count = settings.components ? most : stop.best();
  out.coefficients = encoder.recorder().encode(ends[out.component_count]);
  Planes planes;
  for (uint32_t k = 0; k < out.component_count; ++k) planes.push_back(field.plane(k));
  return planes;
}

GroupEncoder::Planes MainGroupEncoder::code_basis(const Planes& targets, MagnitudeModel& contexts,
                                                  CodedGroup& out) {
  Field field(temporal_.graph, basis_field_options(), threads_);
  std::swap(field.model(), contexts);
  FieldEncoder encoder(field, temporal_.graph, kBasisLambda, 0);
  for (const std::vector<float>& target : targets) encoder.code_component(target.data());
  out.basis = encoder.recorder().encode(encoder.recorder().size());
  std::swap(field.model(), contexts);
  return field.take_planes();
}

}  // namespace reeb
