#include "codec/enc/attributes/animated_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>

#include "bitstream/attribute_group_body.h"
#include "bitstream/element_bound.h"
#include "bitstream/group_payload.h"
#include "bitstream/syntax.h"
#include "codec/dec/attributes/attribute_decoder.h"
#include "codec/enc/attributes/number_choice.h"
#include "codec/enc/fields/correction_encoder.h"
#include "codec/enc/fields/group_encoder.h"
#include "codec/enc/lossless/lossless_group_encoder.h"
#include "codec/enc/search/profile_tools.h"
#include "codec/enc/search/step_search.h"
#include "entropy/interval_coder.h"

namespace reeb {

namespace {

constexpr uint32_t kPart = 3;                  ///< channels
constexpr double kBinary32Rounding = 0x1p-22;  ///< of a coordinate, there and back
constexpr double kMaxRoughness = 0.25;         ///< of the error, lost to rounding
constexpr double kBoundPerError = 2.5;  ///< guess of the bound on corrected errors, in RMS errors
constexpr double kStepRatio = 1.5;      ///< between the steps tried

/// True where frame t of all is equal at both elements.
bool same_always(const Attribute& a, size_t elements, uint32_t x, uint32_t y) {
  const size_t bytes = a.element_bytes();
  for (size_t start = 0; start < a.values.size(); start += elements * bytes) {
    if (std::memcmp(&a.values[start + x * bytes], &a.values[start + y * bytes], bytes) != 0)
      return false;
  }
  return true;
}

SurfaceContext surface_of(SiteMesh sites) {
  SurfaceContext out;
  out.header.grid_step = 0;
  out.mesh.vertex_count = sites.count;
  out.mesh.grid = std::move(sites.grid);
  out.mesh.triangles = std::move(sites.triangles);
  out.surface = Surface(out.mesh);
  out.input_of.resize(sites.count);
  std::iota(out.input_of.begin(), out.input_of.end(), 0u);
  out.input = out.surface.order;
  out.row_of.resize(sites.count);
  for (uint32_t row = 0; row < sites.count; ++row) out.row_of[out.input[row]] = row;
  return out;
}

float number(const Attribute& a, size_t i) {
  switch (a.type) {
    case ValueType::kBinary32:
      return a.get<float>(i);
    case ValueType::kI32:
      return static_cast<float>(a.get<int32_t>(i));
    case ValueType::kU16:
    case ValueType::kU16Normalised:
      return a.get<uint16_t>(i);
    case ValueType::kU8:
    case ValueType::kU8Normalised:
      break;
  }
  return a.get<uint8_t>(i);
}

GroupHeader header_of(const AttributeGroupHeader& group, Profile profile) {
  GroupHeader h;
  h.first_frame = group.first_frame;
  h.frame_count = group.frame_count;
  h.shot = group.shot;
  h.profile = profile;
  return h;
}

/// A part of so many sites.
std::vector<uint8_t> payload_of(const GroupHeader& header, size_t sites,
                                const GroupSections& sections) {
  std::vector<uint8_t> padded, out;
  (void)write_group_payload(header, within_element_bound(header, sites, sections, padded), out);
  return out;
}

}  // namespace

Status AnimatedEncoder::begin(const Attribute& attribute, const ShotSurface& surface,
                              CodedAttribute& coded) {
  constexpr float kMaxInteger = 1 << 24;
  for (size_t i = 0; i < attribute.values.size() / size_of(attribute.type); ++i) {
    const float x = number(attribute, i);
    if (!std::isfinite(x))
      return Status::invalid("attribute \"" + attribute.name +
                             "\": a value that changes over time is not finite");
    if (attribute.type == ValueType::kI32 && std::abs(x) > kMaxInteger)
      return Status::invalid("attribute \"" + attribute.name +
                             "\": an integer that changes over time is beyond 2^24");
  }
  coded = {};
  coded.header = header_of(attribute);
  for (const std::string& name : attribute.names) coded.body.names.push_back({name});
  IntervalEncoder coder;
  const size_t elements = element_count(attribute.domain, surface.connectivity);
  Sites sites = code_sites(coder, attribute.domain, surface, [&](uint32_t a, uint32_t b) {
    return !same_always(attribute, elements, a, b);
  });
  coded.section = coder.finish();
  begin(attribute, elements, std::move(sites));
  return {};
}

void AnimatedEncoder::begin(const Attribute& attribute, size_t frame_elements, Sites sites) {
  attribute_ = &attribute;
  frame_elements_ = frame_elements;
  elements_.resize(sites.mesh.count);
  std::iota(elements_.begin(), elements_.end(), size_t{0});
  for (size_t e = 0; e < sites.of_element.size(); ++e) elements_[sites.of_element[e]] = e;
  surface_ = surface_of(std::move(sites.mesh));
}

std::vector<float> AnimatedEncoder::gather(uint32_t part, const std::vector<double>& scales,
                                           uint32_t first_frame, uint32_t frames) const {
  const uint32_t channels = attribute_->channel_count;
  const size_t sites = elements_.size();
  std::vector<float> out(kPart * sites * frames);
  for (uint32_t k = kPart * part; k < std::min(kPart * (part + 1), channels); ++k) {
    for (uint32_t t = 0; t < frames; ++t) {
      for (size_t i = 0; i < sites; ++i) {
        const size_t element = (first_frame + t) * frame_elements_ + elements_[i];
        const auto x = static_cast<double>(number(*attribute_, element * channels + k));
        out[(t * sites + i) * kPart + k % kPart] = static_cast<float>(x / scales[k]);
      }
    }
  }
  return out;
}

std::vector<uint8_t> AnimatedEncoder::encode_exactly(const std::vector<float>& coordinates,
                                                     double step, const AttributeGroupHeader& group,
                                                     const AnimatedOptions& options) const {
  ExactFrames frames;
  const size_t sites = elements_.size();
  std::vector<float> frame(kPart * sites), before;
  for (uint32_t t = 0; t < group.frame_count; ++t) {
    for (size_t row = 0; row < sites; ++row)
      std::copy_n(&coordinates[(t * sites + surface_.input[row]) * kPart], kPart,
                  &frame[row * kPart]);
    const bool repeats =
        t > 0 && std::memcmp(frame.data(), before.data(), frame.size() * sizeof(float)) == 0;
    repeats ? frames.repeat(1) : frames.add(frame);
    before = frame;
  }
  const LosslessGroup coded = encode_lossless_group(
      surface_, frames, {.quick = options.quick, .step = step}, options.threads);
  GroupHeader header = header_of(group, Profile::kLossless);
  header.stored_count = coded.stored_count;
  if (options.quick) header.flags |= GroupHeader::kQuick;
  return payload_of(header, elements_.size(), {.differences = coded.differences, .raw = coded.raw});
}

std::vector<uint8_t> AnimatedEncoder::encode_roughly(const std::vector<float>& coordinates,
                                                     double bound,
                                                     const AttributeGroupHeader& group,
                                                     const AnimatedOptions& options) const {
  Shot shot;
  shot.connectivity.vertex_count = static_cast<uint32_t>(elements_.size());
  shot.frame_count = group.frame_count;
  shot.positions = coordinates;
  const auto encoder =
      tools_of(options.profile)
          .make_encoder(make_group_signal(shot, 0, group.frame_count), options.threads);
  std::vector<uint8_t> best;
  const double q0 = 2 * bound / kBoundPerError * std::sqrt(static_cast<double>(group.frame_count));
  search_least(q0, kStepRatio, options.trials, [&](double q) {
    GroupRun run;
    GroupSettings settings;
    settings.q = q;
    const CodedGroup coded = encoder->encode(surface_, settings, nullptr, run);
    const CodedCorrections corrections =
        encode_corrections(coded.synthesis, coordinates, surface_, bound);
    GroupHeader header = header_of(group, options.profile);
    header.component_count = coded.component_count;
    header.quantization_step = static_cast<float>(coded.q);
    if (coded.weak_prior) header.flags |= GroupHeader::kWeakPrior;
    if (corrections.count > 0) {
      header.flags |= GroupHeader::kCorrected;
      header.correction_step = corrections.step;
      header.correction_count = corrections.count;
    }
    const std::vector<uint8_t> bytes = payload_of(
        header, elements_.size(), {{}, coded.coefficients, coded.basis, corrections.bytes});
    if (best.empty() || bytes.size() < best.size()) best = bytes;
    return static_cast<double>(bytes.size());
  });
  return best;
}

// Three channels are exact together, where one of them is to be, or where binary32 has no room for
// their errors.
std::vector<uint8_t> AnimatedEncoder::encode_part(uint32_t part, uint32_t first_frame,
                                                  const AttributeGroupHeader& group,
                                                  const AnimatedOptions& options,
                                                  std::vector<double>& scales) const {
  bool exact = false;
  for (uint32_t k = kPart * part; k < std::min<size_t>(kPart * (part + 1), scales.size()); ++k) {
    scales[k] = channel_error(*attribute_, k);
    exact = exact || scales[k] == 0;
  }
  std::vector<float> coordinates;
  double roughness = 0;
  if (!exact) {
    coordinates = gather(part, scales, first_frame, group.frame_count);
    for (const float x : coordinates)
      roughness = std::max(roughness, std::abs(static_cast<double>(x)) * kBinary32Rounding);
  }
  if (exact || roughness > kMaxRoughness) {
    for (uint32_t k = kPart * part; k < std::min<size_t>(kPart * (part + 1), scales.size()); ++k)
      scales[k] = 1;
    return encode_exactly(gather(part, scales, first_frame, group.frame_count), 0, group, options);
  }
  const double bound = 1 - roughness, step = 2 * bound;
  std::vector<uint8_t> out = encode_roughly(coordinates, bound, group, options);
  if (options.profile != Profile::kMain) return out;
  // Noise may be better coded as multiples of what it may be off.
  for (float& x : coordinates)
    x = static_cast<float>(std::floor(static_cast<double>(x) / step + 0.5) * step);
  std::vector<uint8_t> other = encode_exactly(coordinates, step, group, options);
  return other.size() < out.size() ? other : out;
}

Status AnimatedEncoder::encode_group(const AttributeGroupHeader& group, uint32_t first_frame,
                                     const AnimatedOptions& options,
                                     std::vector<uint8_t>& out) const {
  const uint32_t parts = (attribute_->channel_count + kPart - 1) / kPart;
  AttributeGroupBody body;
  std::vector<uint8_t> payloads;
  std::vector<double> scales(attribute_->channel_count);
  for (uint32_t p = 0; p < parts; ++p) {
    const std::vector<uint8_t> payload = encode_part(p, first_frame, group, options, scales);
    body.parts.push_back({payload.size()});
    payloads.insert(payloads.end(), payload.begin(), payload.end());
  }
  for (const double scale : scales) body.scales.push_back({scale});
  out.clear();
  if (Status s = write_header(body, "agrp", out); !s.ok()) return s;
  out.insert(out.end(), payloads.begin(), payloads.end());
  return {};
}

}  // namespace reeb
