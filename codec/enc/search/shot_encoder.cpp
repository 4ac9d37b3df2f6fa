#include "codec/enc/search/shot_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bitstream/element_bound.h"
#include "codec/enc/search/group_plan.h"
#include "segmentation/segmentation.h"
#include "segmentation/union_find.h"

namespace reeb {

namespace {

constexpr double kGroupOverhead = 8 * 60;  ///< bits of headers, checksums and the seek table
// Weights need no finer reference than this; fitted to what trials chose on ten sequences.
constexpr double kGridBase = 3.6;
constexpr double kGridSlope = 0.6;  ///< bits per halving of the error

}  // namespace

ShotEncoder::ShotEncoder(const Shot& shot, const Shot& base, uint32_t first_frame,
                         const EncodeOptions& options, unsigned threads)
    : shot_(shot),
      base_(base),
      plan_(shot.connectivity),
      first_frame_(first_frame),
      reorder_(options.reorder),
      profile_(options.profile),
      stop_(options.stop),
      bound_(options.target == Target::kMaxError ? options.target_value : 0),
      longest_side_(bounds_of(base.frame(0)).side) {
  const GroupPlan groups = plan_groups(shot, options);
  open_groups_ = groups.open_groups;
  uint32_t first = 0;
  for (const uint32_t length : groups.lengths) {
    GroupSignal signal = make_group_signal(base, first, length);
    energy_ += signal.energy;
    largest_ = std::max(largest_, signal.largest);
    groups_.push_back({first, tools_of(profile_).make_encoder(std::move(signal), threads)});
    first += length;
  }
}

double ShotEncoder::vertex_frames() const {
  return static_cast<double>(shot_.connectivity.vertex_count) *
         static_cast<double>(shot_.frame_count);
}

double ShotEncoder::best_grid_bits(double error) const {
  const double precision = error > 0 ? std::log2(longest_side_ / error) : 0;
  return std::clamp(kGridBase + kGridSlope * precision, double{kMinGridBits}, double{kMaxGridBits});
}

Status ShotEncoder::prepare(const ShotSettings& settings) {
  std::erase_if(made_, [](const MadeSurface& m) { return m.surface.expired(); });
  for (const MadeSurface& m : made_) {
    if (m.grid_bits != settings.grid_bits || m.plain != settings.plain) continue;
    surface_ = m.surface.lock();
    return {};
  }
  auto made = std::make_shared<SurfaceContext>();
  const ReferenceOptions options{.reorder = reorder_, .plain = settings.plain};
  if (Status s = make_surface_context(base_, plan_, settings.grid_bits, options, *made); !s.ok())
    return s;
  surface_ = std::move(made);
  made_.push_back({settings.grid_bits, settings.plain, surface_});
  return {};
}

// Label of each vertex of the input.
std::vector<uint32_t> ShotEncoder::find_regions(uint32_t wanted, uint32_t& count) {
  if (reeb_regions_ == nullptr) {
    for (const uint32_t v : surface_->mesh.triangles) triangles_.push_back(surface_->input_of[v]);
    reeb_regions_ =
        std::make_unique<segmentation::Result>(segmentation::segment(base_.frame(0), triangles_));
  }
  if (wanted == ShotSettings::kReebRegions) {
    count = reeb_regions_->region_count;
    return reeb_regions_->labels;
  }
  if (partitions_ == nullptr) {
    const segmentation::MotionInput input{base_.frame(0), triangles_, base_.positions};
    partitions_ = std::make_unique<segmentation::MotionPartitions>(input, *reeb_regions_);
  }
  count = std::clamp(wanted, 1u, partitions_->finest());
  return partitions_->labels(count);
}

void ShotEncoder::fit_motion(uint32_t wanted) {
  if (motion_.surface == surface_ && motion_.wanted == wanted) return;
  motion_ = {surface_, wanted, 0, {}};
  if (wanted == 0) return;
  const std::vector<uint32_t> labels = find_regions(wanted, motion_.regions);
  for (const Group& group : groups_) {
    motion_.fits.push_back(std::make_unique<MotionFit>(
        *surface_, group.encoder->motion_targets(*surface_), labels, motion_.regions));
  }
}

GroupSettings ShotEncoder::group_settings(const ShotSettings& settings, double q,
                                          size_t group) const {
  GroupSettings out = {.q = q, .weak_prior = settings.weak_prior, .components = {}, .stop = stop_};
  if (!settings.components.empty()) out.components = settings.components[group];
  return out;
}

RatePoint ShotEncoder::expect(const ShotSettings& settings, double q) {
  RatePoint out{8 * static_cast<double>(surface_->bytes.size()), 0};
  for (size_t i = 0; i < groups_.size(); ++i) {
    const RatePoint point = groups_[i].encoder->expect(*surface_, group_settings(settings, q, i));
    out.bits += point.bits + kGroupOverhead;
    out.distortion += point.distortion;
  }
  return out;
}

Status ShotEncoder::encode(const ShotSettings& settings, double q, CodedShot& out) {
  if (Status s = prepare(settings); !s.ok()) return s;
  fit_motion(settings.regions);
  out = {surface_, {}, motion_.regions};
  GroupRun run;
  for (uint32_t i = 0; i < groups_.size(); ++i) {
    run.continues = continues(i);
    run.continued = i + 1 < groups_.size() && continues(i + 1);
    const MotionFit* motion = motion_.fits.empty() ? nullptr : motion_.fits[i].get();
    out.groups.push_back(
        groups_[i].encoder->encode(*surface_, group_settings(settings, q, i), motion, run));
    if (stop_.requested()) return Status::cancelled();
    if (bound_ > 0) correct(groups_[i], out.groups.back());
  }
  return {};
}

void ShotEncoder::correct(const Group& group, CodedGroup& coded) const {
  const size_t frame_size = size_t{surface_->rows()} * 3;
  const std::span<const float> original =
      std::span(shot_.positions)
          .subspan(group.first_frame * frame_size, coded.synthesis.frame_count() * frame_size);
  CodedCorrections corrections = encode_corrections(coded.synthesis, original, *surface_, bound_);
  if (corrections.count == 0) return;
  coded.synthesis.set_corrections(std::move(corrections.corrections));
  coded.corrections = std::move(corrections);
}

GroupHeader ShotEncoder::header_of(const CodedGroup& coded, uint32_t group) const {
  GroupHeader header;
  header.first_frame = first_frame_ + groups_[group].first_frame;
  header.frame_count = groups_[group].encoder->signal().frames;
  header.profile = profile_;
  std::copy(std::begin(coded.axis_step), std::end(coded.axis_step), header.axis_step);
  header.component_count = coded.component_count;
  header.quantization_step = static_cast<float>(coded.q);
  header.region_count = coded.region_count;
  if (continues(group)) header.flags |= GroupHeader::kContinues;
  if (coded.weak_prior) header.flags |= GroupHeader::kWeakPrior;
  if (coded.corrections.has_value()) {
    header.flags |= GroupHeader::kCorrected;
    header.correction_step = coded.corrections->step;
    header.correction_count = coded.corrections->count;
  }
  return header;
}

Status ShotEncoder::write(uint32_t shot_index, const CodedShot& coded,
                          ContainerWriter& writer) const {
  ReferenceHeader reference = coded.surface->header;
  reference.shot = shot_index;
  reference.first_frame = first_frame_;
  if (Status s = writer.reference(reference, coded.surface->bytes); !s.ok()) return s;
  for (uint32_t i = 0; i < coded.groups.size(); ++i) {
    const CodedGroup& group = coded.groups[i];
    GroupHeader header = header_of(group, i);
    header.shot = shot_index;
    GroupSections sections{
        .motion = group.motion, .coefficients = group.coefficients, .basis = group.basis};
    if (group.corrections.has_value()) sections.corrections = group.corrections->bytes;
    std::vector<uint8_t> padded;
    sections = within_element_bound(header, shot_.connectivity.vertex_count, sections, padded);
    if (Status s = writer.group(header, sections); !s.ok()) return s;
  }
  return {};
}

ErrorSums ShotEncoder::measure(const CodedShot& coded) const {
  std::vector<float> frame(shot_.frame(0).size());
  ErrorSums sums;
  for (size_t i = 0; i < coded.groups.size(); ++i) {
    const GroupSynthesis& synthesis = coded.groups[i].synthesis;
    for (uint32_t t = 0; t < synthesis.frame_count(); ++t) {
      synthesis.frame(t, frame.data(), 3);
      sums.add(shot_.frame(groups_[i].first_frame + t), frame);
    }
  }
  return sums;
}

double largest_piece(const Connectivity& mesh) {
  segmentation::UnionFind pieces(mesh.vertex_count);
  size_t first = 0;
  for (const uint32_t size : mesh.face_sizes) {
    for (size_t i = first + 1; i < first + size; ++i)
      pieces.unite(mesh.corners[first], mesh.corners[i]);
    first += size;
  }
  std::vector<uint32_t> size(mesh.vertex_count);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) ++size[pieces.find(v)];
  return *std::max_element(size.begin(), size.end()) / static_cast<double>(size.size());
}

}  // namespace reeb
