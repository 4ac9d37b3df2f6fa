#include "codec/enc/search/shot_encoder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "segmentation/segmentation.h"

namespace reeb {

namespace {

constexpr uint32_t kMinBits = 9;
constexpr uint32_t kMaxBits = 16;
constexpr double kGroupOverhead = 8 * 60;  ///< bits of headers, checksums and the seek table
// Weights need no finer reference than this; fitted to what trials chose on ten sequences.
constexpr double kGridBase = 3.6;
constexpr double kGridSlope = 0.6;       ///< bits per halving of the error
constexpr uint32_t kLongestGroup = 512;  ///< frames, unless asked for
constexpr uint64_t kGroupSamples =
    100'000'000;  ///< vertices times frames, to bound the encoder's memory

uint32_t default_group_length(const Shot& shot) {
  const uint64_t by_memory = std::max<uint64_t>(1, kGroupSamples / shot.connectivity.vertex_count);
  return static_cast<uint32_t>(std::min<uint64_t>(kLongestGroup, by_memory));
}

/// Lengths as equal as can be, none above `longest`.
std::vector<uint32_t> split_evenly(uint32_t frames, uint32_t longest) {
  const uint32_t parts = (frames + longest - 1) / longest;
  std::vector<uint32_t> lengths(parts, frames / parts);
  for (uint32_t i = 0; i < frames % parts; ++i) ++lengths[i];
  return lengths;
}

/// Groups of the length asked for, the last one shorter.
std::vector<uint32_t> split_by(uint32_t frames, uint32_t length) {
  std::vector<uint32_t> lengths(frames / length, length);
  if (frames % length != 0) lengths.push_back(frames % length);
  return lengths;
}

}  // namespace

ShotEncoder::ShotEncoder(const Shot& shot, uint32_t first_frame, const EncodeOptions& options,
                         unsigned threads)
    : shot_(shot),
      plan_(shot.connectivity),
      first_frame_(first_frame),
      reorder_(options.reorder),
      profile_(options.profile),
      plain_(options.profile == Profile::kFast),
      bound_(options.target == Target::kMaxError ? options.target_value : 0),
      open_groups_(options.open_groups) {
  const std::vector<uint32_t> lengths =
      options.group_length > 0 ? split_by(shot.frame_count, options.group_length)
                               : split_evenly(shot.frame_count, default_group_length(shot));
  uint32_t first = 0;
  for (const uint32_t length : lengths) {
    GroupSignal signal = make_group_signal(shot, first, length);
    energy_ += signal.energy;
    largest_ = std::max(largest_, signal.largest);
    groups_.push_back({first, make_group_encoder(std::move(signal), profile_, threads), nullptr});
    first += length;
  }
}

double ShotEncoder::vertex_frames() const {
  return static_cast<double>(shot_.connectivity.vertex_count) *
         static_cast<double>(shot_.frame_count);
}

double ShotEncoder::longest_side() const {
  const std::span<const float> xyz = shot_.frame(0);
  double side = 0;
  for (size_t a = 0; a < 3; ++a) {
    float low = xyz[a];
    float high = xyz[a];
    for (size_t i = a; i < xyz.size(); i += 3) {
      low = std::min(low, xyz[i]);
      high = std::max(high, xyz[i]);
    }
    side = std::max(side, static_cast<double>(high) - static_cast<double>(low));
  }
  return side;
}

Status ShotEncoder::set_grid(double error) {
  return set_grid_bits(static_cast<uint32_t>(std::lround(best_grid_bits(error))));
}

double ShotEncoder::best_grid_bits(double error) const {
  const double precision = error > 0 ? std::log2(longest_side() / error) : 0;
  return std::clamp(kGridBase + kGridSlope * precision, double{kMinBits}, double{kMaxBits});
}

Status ShotEncoder::set_grid_bits(uint32_t bits) {
  const uint32_t allowed = std::clamp(bits, kMinBits, kMaxBits);
  if (allowed == grid_bits_) return {};
  if (allowed == spare_bits_) {
    std::swap(surface_, spare_);
    std::swap(grid_bits_, spare_bits_);
  } else {
    SurfaceContext surface;
    const ReferenceOptions options{
        .reorder = reorder_, .plain = plain_, .lanes = profile_ == Profile::kFast};
    if (Status s = make_surface_context(shot_, plan_, allowed, options, surface); !s.ok()) return s;
    spare_ = std::exchange(surface_, std::move(surface));
    spare_bits_ = std::exchange(grid_bits_, allowed);
  }
  fit_motion();
  return {};
}

Status ShotEncoder::set_plain(bool plain) {
  if (plain == plain_) return {};
  plain_ = plain;
  spare_bits_ = 0;
  return set_grid_bits(std::exchange(grid_bits_, 0));
}

double ShotEncoder::largest_piece() const {
  std::vector<uint32_t> parent(surface_.mesh.vertex_count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const std::vector<uint32_t>& triangles = surface_.mesh.triangles;
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    for (const size_t j : {i + 1, i + 2}) parent[root(triangles[j])] = root(triangles[i]);
  }
  std::vector<uint32_t> size(parent.size());
  for (uint32_t v = 0; v < parent.size(); ++v) ++size[root(v)];
  return *std::max_element(size.begin(), size.end()) / static_cast<double>(size.size());
}

void ShotEncoder::segment_reference() {
  if (reeb_regions_ != nullptr) return;
  for (const uint32_t v : surface_.mesh.triangles) triangles_.push_back(surface_.input_of[v]);
  reeb_regions_ =
      std::make_unique<segmentation::Result>(segmentation::segment(shot_.frame(0), triangles_));
}

void ShotEncoder::set_reeb_regions() {
  segment_reference();
  labels_ = reeb_regions_->labels;
  regions_ = reeb_regions_->region_count;
  fit_motion();
}

void ShotEncoder::set_regions(uint32_t count) {
  regions_ = 0;
  if (count > 0) {
    segment_reference();
    if (partitions_ == nullptr) {
      const segmentation::MotionInput input{shot_.frame(0), triangles_, shot_.positions};
      partitions_ = std::make_unique<segmentation::MotionPartitions>(input, *reeb_regions_);
    }
    regions_ = std::clamp(count, 1u, partitions_->finest());
    labels_ = partitions_->labels(regions_);
  }
  fit_motion();
}

void ShotEncoder::fit_motion() {
  for (Group& group : groups_) {
    group.motion.reset();
    if (regions_ == 0) continue;
    group.motion = std::make_unique<MotionFit>(surface_, group.encoder->motion_targets(surface_),
                                               labels_, regions_);
  }
}

RatePoint ShotEncoder::expect(double q) {
  RatePoint out{8 * static_cast<double>(surface_.bytes.size()), 0};
  for (const Group& group : groups_) {
    const RatePoint point = group.encoder->expect(surface_, q);
    out.bits += point.bits + kGroupOverhead;
    out.distortion += point.distortion;
  }
  return out;
}

void ShotEncoder::set_weak_prior(bool weak_prior) {
  for (Group& group : groups_) group.encoder->set_weak_prior(weak_prior);
}

void ShotEncoder::hold_components(const std::vector<CodedGroup>& coded) {
  for (size_t i = 0; i < groups_.size(); ++i) {
    std::optional<uint32_t> count;
    if (!coded.empty()) count = coded[i].component_count;
    groups_[i].encoder->hold_components(count);
  }
}

std::vector<CodedGroup> ShotEncoder::encode(double q) {
  std::vector<CodedGroup> out;
  GroupRun run;
  for (uint32_t i = 0; i < groups_.size(); ++i) {
    run.continues = continues(i);
    run.continued = i + 1 < groups_.size() && continues(i + 1);
    out.push_back(groups_[i].encoder->encode(surface_, q, groups_[i].motion.get(), run));
    if (bound_ > 0) correct(groups_[i], out.back());
  }
  return out;
}

void ShotEncoder::correct(const Group& group, CodedGroup& coded) const {
  const size_t frame_size = size_t{surface_.rows()} * 3;
  const std::span<const float> original =
      std::span(shot_.positions)
          .subspan(group.first_frame * frame_size, coded.synthesis.frame_count() * frame_size);
  CodedCorrections corrections = encode_corrections(coded.synthesis, original, surface_, bound_);
  if (corrections.count == 0) return;
  coded.synthesis.set_corrections(std::move(corrections.corrections));
  coded.corrections = std::move(corrections);
}

Status ShotEncoder::write(uint32_t shot_index, const std::vector<CodedGroup>& coded,
                          ContainerWriter& writer) const {
  ReferenceHeader reference = surface_.header;
  reference.shot = shot_index;
  reference.first_frame = first_frame_;
  if (Status s = writer.reference(reference, surface_.bytes); !s.ok()) return s;
  for (size_t i = 0; i < coded.size(); ++i) {
    GroupHeader header;
    header.first_frame = first_frame_ + groups_[i].first_frame;
    header.frame_count = groups_[i].encoder->signal().frames;
    header.shot = shot_index;
    header.profile = profile_;
    std::copy(std::begin(coded[i].axis_step), std::end(coded[i].axis_step), header.axis_step);
    header.component_count = coded[i].component_count;
    header.quantization_step = static_cast<float>(coded[i].q);
    header.region_count = coded[i].region_count;
    if (continues(static_cast<uint32_t>(i))) header.flags |= GroupHeader::kContinues;
    if (coded[i].weak_prior) header.flags |= GroupHeader::kWeakPrior;
    GroupSections sections{coded[i].motion, coded[i].coefficients, coded[i].basis, {}};
    if (const auto& c = coded[i].corrections; c.has_value()) {
      header.flags |= GroupHeader::kCorrected;
      header.correction_step = c->step;
      header.correction_count = c->count;
      sections.corrections = c->bytes;
    }
    Status s = writer.group(header, sections);
    if (!s.ok()) return s;
  }
  return {};
}

ErrorSums ShotEncoder::measure(const std::vector<CodedGroup>& coded) const {
  std::vector<float> frame(shot_.frame(0).size());
  ErrorSums sums;
  for (size_t i = 0; i < coded.size(); ++i) {
    for (uint32_t t = 0; t < coded[i].synthesis.frame_count(); ++t) {
      coded[i].synthesis.frame(t, frame.data(), 3);
      const std::span<const float> original = shot_.frame(groups_[i].first_frame + t);
      for (size_t v = 0; v < frame.size(); v += 3) {
        double square = 0;
        for (size_t a = 0; a < 3; ++a) {
          const double d = static_cast<double>(frame[v + a]) - static_cast<double>(original[v + a]);
          square += d * d;
          sums.largest = std::max(sums.largest, std::abs(d));
        }
        sums.squared += square;
      }
    }
  }
  return sums;
}

}  // namespace reeb
