#include "codec/enc/search/sequence_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "codec/common/base/coding_tools.h"
#include "codec/common/base/parallel.h"
#include "codec/enc/search/sequence_summary.h"
#include "codec/enc/search/step_search.h"

namespace reeb {

namespace {

constexpr double kGuessedPrecision =
    2e-4;                              ///< of the extent: error expected where the target is a size
constexpr double kAnyStep = 1e-6;      ///< where nothing moves
constexpr double kMaxSteps = 1 << 24;  ///< of a coefficient; binary32 keeps no more
// Steps as headers hold them.
constexpr double kMinStep = std::numeric_limits<float>::min();
constexpr double kMaxStep = 1e37;
constexpr double kNear = 0.1;  ///< of the target, where settings are compared
// What an error measured in coefficients may fall short of the one of rounded positions; where that
// does not do, a second search measures positions.
constexpr double kRounding = 1.0005;
constexpr double kPolishStride = 0.003;  ///< in ln q, between steps tried beside the last one
constexpr int kHalvings = 7;             ///< of an octave of steps, to find the first one
constexpr double kSlopeStride = 1.2;     ///< ratio of steps between which a slope is taken
constexpr int kRoughTrials = 6;
constexpr int kTrials = 10;
constexpr double kBoundPerError = 2.5;  ///< guess of the bound on corrected errors, in RMS errors
constexpr double kBaseRatio = 1.35;     ///< between the steps tried under corrections
// Squared error in q^2 that a bit is worth where settings are compared: most coefficients are 0, so
// it is more than the ln(2) / 6 of a fine quantizer.
constexpr double kErrorPerBit = 0.14;
constexpr size_t kShort = 64;  ///< frames of a shot whose reference mesh may take longer to decode
constexpr double kSlowMeshShare = 0.6;  ///< of the size, where that pays
constexpr double kWholeSurface = 0.9;   ///< of the vertices in one piece
constexpr uint32_t kRegionCandidates[] = {12, 40};

uint32_t grid_within(long bits) {
  return static_cast<uint32_t>(
      std::clamp(bits, long{ShotEncoder::kMinGridBits}, long{ShotEncoder::kMaxGridBits}));
}

/// The nearest that the search came to a target that it did not meet.
Status unreachable(const EncodeStats& nearest) {
  char errors[80];
  std::snprintf(errors, sizeof errors, "KG %.4g %%, largest error %.4g", nearest.kg,
                nearest.max_error);
  return Status::invalid("the target is out of reach; nearest: " + std::string(errors) + ", " +
                         std::to_string(nearest.bytes) + " bytes");
}

}  // namespace

SequenceEncoder::SequenceEncoder(const Sequence& sequence, const Sequence& base,
                                 const EncodeOptions& options)
    : sequence_(sequence),
      options_(options),
      effort_(effort_preset(options.effort)),
      tools_(tools_of(options.profile)) {
  uint32_t first_frame = 0;
  for (size_t i = 0; i < sequence.shots.size(); ++i) {
    const Shot& shot = sequence.shots[i];
    shots_.push_back(std::make_unique<ShotEncoder>(shot, base.shots[i], first_frame, options,
                                                   resolve_threads(options.threads)));
    first_frame += shot.frame_count;
    energy_ += shots_.back()->energy();
    vertex_frames_ += shots_.back()->vertex_frames();
  }
}

bool SequenceEncoder::advance(double part) {
  done_ = std::max(done_, part);
  return !options_.progress || options_.progress(done_);
}

double SequenceEncoder::kg_of(double squared_error) const {
  return kg_error(squared_error, energy_);
}

double SequenceEncoder::excess_of(const Attempt& a) const {
  double measured = 0;
  switch (options_.target) {
    case Target::kKg:
      measured = exact_ ? kg_of(measure(a).squared) : kg_of(a.squared_error) * kRounding;
      break;
    case Target::kMaxError:
      return 0;  // whatever the step
    case Target::kBpvf:
    case Target::kSize:
      measured = static_cast<double>(a.bytes.size()) / bytes_per_unit();
      break;
    case Target::kLossless:  // see encode_lossless
      break;
  }
  return measured > 0 ? std::log(measured / options_.target_value) : -1e3;
}

Status SequenceEncoder::attempt(const Settings& settings, double q, Attempt& out) {
  out = {};
  out.settings = settings;
  out.q = q;
  ContainerWriter writer(out.bytes);
  if (Status s = writer.begin(header_of(sequence_)); !s.ok()) return s;
  if (Status s = writer.metadata(metadata_of(sequence_)); !s.ok()) return s;
  for (uint32_t i = 0; i < shots_.size(); ++i) {
    CodedShot& shot = out.shots.emplace_back();
    if (Status s = shots_[i]->encode(settings[i], q, shot); !s.ok()) return s;
    for (const CodedGroup& g : shot.groups) out.squared_error += g.squared_error;
    if (Status s = shots_[i]->write(i, shot, writer); !s.ok()) return s;
  }
  if (Status s = writer.finish(); !s.ok()) return s;
  out.excess = excess_of(out);
  if (!advance(done_ + (1 - done_) * 0.15))
    return {StatusCode::kCancelled, "encoding was cancelled"};
  return {};
}

Status SequenceEncoder::search(double slack, double tolerance, int max_trials) {
  const Settings settings = best_.settings;
  Status status = prepare(settings);
  if (!status.ok()) return status;
  const StepSearchOptions search_options{is_error(options_.target), tolerance, max_trials,
                                         least_step(), expected_slope(settings, best_.q)};
  std::vector<Attempt> attempts;
  attempts.push_back(std::move(best_));
  const StepTrial first{attempts[0].q, attempts[0].excess - slack};
  const StepTrial found = search_step(first, search_options, [&](double q) {
    Attempt a;
    if (status.ok()) status = attempt(settings, q, a);
    attempts.push_back(std::move(a));
    return status.ok() ? attempts.back().excess - slack : 0;
  });
  if (!status.ok()) return status;
  best_ = std::move(*std::find_if(attempts.begin(), attempts.end(),
                                  [&](const Attempt& a) { return a.q == found.q; }));
  return {};
}

// The reconstruction underneath may be rough, since corrections bound the error whatever it is: the
// best one makes the smallest file.
Status SequenceEncoder::search_base() {
  const double rms = coordinate_error();
  const double wanted = options_.target_value / kBoundPerError;
  const double scale = rms > 0 ? std::clamp(wanted / rms, 0.1, 10.0) : 1.0;
  const double q0 = std::max(best_.q * scale, least_step());
  const Settings settings = best_.settings;
  Status status;
  search_least(q0, kBaseRatio, effort_.base_trials, [&](double q) {
    Attempt a;
    if (status.ok()) status = attempt(settings, std::max(q, least_step()), a);
    if (!status.ok()) return 0.0;
    const auto size = static_cast<double>(a.bytes.size());
    if (a.bytes.size() < best_.bytes.size()) best_ = std::move(a);
    return size;
  });
  return status;
}

void SequenceEncoder::hold_components(bool held) {
  for (size_t i = 0; i < shots_.size(); ++i) {
    std::vector<uint32_t>& components = best_.settings[i].components;
    components.clear();
    if (!held) continue;
    for (const CodedGroup& g : best_.shots[i].groups) components.push_back(g.component_count);
  }
}

Status SequenceEncoder::finish_search() {
  if (bounded()) return {};
  // As many components as pay at the step that is likely to be the last; with their number the
  // error would jump by more than the tolerance.
  hold_components(false);
  if (Status s = search(0, effort_.tolerance, 1); !s.ok()) return s;
  hold_components(true);
  if (Status s = search(0, effort_.tolerance, kTrials); !s.ok()) return s;
  if (meets(best_)) return polish();
  hold_components(false);
  return search(0, effort_.tolerance, kTrials);
}

bool SequenceEncoder::meets(const Attempt& a) const {
  return a.excess <= 0 && a.excess >= -kMetTolerance;
}

// Rate and error do not follow the step smoothly: of steps next to each other one is the best.
Status SequenceEncoder::polish() {
  const double q = best_.q;
  for (int i = 0; i < effort_.polish_trials; ++i) {
    const int stride = i % 2 == 0 ? i / 2 + 1 : -(i / 2 + 1);
    Attempt a;
    if (Status s = attempt(best_.settings, q * std::exp(kPolishStride * stride), a); !s.ok())
      return s;
    const bool better = is_error(options_.target) ? a.bytes.size() < best_.bytes.size()
                                                  : a.squared_error < best_.squared_error;
    if (meets(a) && better) best_ = std::move(a);
  }
  return {};
}

double SequenceEncoder::least_step() const {
  double largest = 0;
  for (const auto& shot : shots_) largest = std::max(largest, shot->largest_coefficient());
  return std::max(largest / kMaxSteps, kMinStep);
}

Status SequenceEncoder::prepare(const Settings& settings) {
  for (size_t i = 0; i < shots_.size(); ++i) {
    if (Status s = shots_[i]->prepare(settings[i]); !s.ok()) return s;
  }
  return {};
}

RatePoint SequenceEncoder::expect(const Settings& settings, double q) const {
  RatePoint out;
  for (size_t i = 0; i < shots_.size(); ++i) {
    const RatePoint point = shots_[i]->expect(settings[i], q);
    out.bits += point.bits;
    out.distortion += point.distortion;
  }
  return out;
}

double SequenceEncoder::guess_step(const Settings& settings) const {
  if (energy_ <= 0) return kAnyStep;
  const auto fine = [&](double x) {
    const RatePoint point = expect(settings, std::exp(x));
    return is_error(options_.target) ? kg_of(point.distortion) < options_.target_value
                                     : point.bits > 8 * options_.target_value * bytes_per_unit();
  };
  // From coarse steps on, since fine ones need components that will not be sent.
  const double least = std::log(least_step());
  double low = 0.5 * std::log(energy_);
  while (low > least && !fine(low)) low -= std::log(2.0);
  for (int i = 1; i <= kHalvings; ++i) {
    const double width = std::log(2.0) * std::exp2(-i);
    if (fine(low + width)) low += width;
  }
  return std::exp(std::max(low, least));
}

double SequenceEncoder::expected_slope(const Settings& settings, double q) const {
  const RatePoint below = expect(settings, q / kSlopeStride);
  const RatePoint above = expect(settings, q * kSlopeStride);
  const double ratio = is_error(options_.target) ? std::sqrt(above.distortion / below.distortion)
                                                 : below.bits / above.bits;
  return std::isfinite(ratio) ? std::log(ratio) / (2 * std::log(kSlopeStride)) : 0;
}

double SequenceEncoder::bytes_per_unit() const {
  return options_.target == Target::kBpvf ? vertex_frames_ / 8 : 1;
}

double SequenceEncoder::coordinate_error() const {
  return std::sqrt(best_.squared_error / (3 * vertex_frames_));
}

SequenceEncoder::Settings SequenceEncoder::with_grids(Settings settings, double error) const {
  for (size_t i = 0; i < shots_.size(); ++i) {
    const ShotEncoder& shot = *shots_[i];
    // Under corrections positions of the reference count for more than weights: about their RMS.
    const double cells = bounded() && error > 0 ? shot.longest_side() / (2 * error) + 1 : 1;
    const double fine = std::ceil(std::log2(std::min(cells, 65536.0)));
    settings[i].grid_bits =
        grid_within(bounded() ? std::lround(fine) : std::lround(shot.best_grid_bits(error)));
  }
  return settings;
}

Status SequenceEncoder::try_settings(const Settings& settings, bool& kept) {
  Attempt a;
  if (Status s = attempt(settings, best_.q, a); !s.ok()) return s;
  const double slope = kErrorPerBit * best_.q * best_.q;
  const auto cost = [&](const Attempt& x) {
    return (bounded() ? 0 : x.squared_error) + slope * 8 * static_cast<double>(x.bytes.size());
  };
  kept = cost(a) < cost(best_);
  if (kept) best_ = std::move(a);
  return {};
}

Status SequenceEncoder::refine_grids() {
  if (!uses(coding_tool::kGridTrial)) return {};
  const double doubt = shots_[0]->best_grid_bits(coordinate_error()) - best_.settings[0].grid_bits;
  int trials = std::abs(doubt) >= 0.5 - effort_.grid_doubt ? effort_.grid_trials : 0;
  // The estimate was made for reconstructions without corrections.
  if (bounded()) trials = effort_.base_trials;
  const int likely = doubt > 0 ? 1 : -1;
  bool moved = false;
  for (const int direction : {likely, -likely}) {
    for (bool kept = true; kept && trials > 0; --trials) {
      Settings settings = best_.settings;
      for (ShotSettings& s : settings) s.grid_bits = grid_within(long{s.grid_bits} + direction);
      if (settings == best_.settings) break;
      if (Status s = try_settings(settings, kept); !s.ok()) return s;
      moved = moved || kept;
    }
    if (moved) break;
  }
  return {};
}

// Short sequences spend much on what a plain mesh makes quick to decode: there the mesh of the main
// profile may halve the size, by coding positions and order better, and isolated vertices.
Status SequenceEncoder::choose_meshes() {
  if (!tools_.plain_mesh || sequence_.frame_count() > kShort * shots_.size()) return {};
  Settings settings = best_.settings;
  for (ShotSettings& s : settings) s.plain = false;
  Attempt a;
  if (Status s = attempt(settings, best_.q, a); !s.ok()) return s;
  const auto most = kSlowMeshShare * static_cast<double>(best_.bytes.size());
  if (static_cast<double>(a.bytes.size()) < most) best_ = std::move(a);
  return {};
}

// Where neighbours tell a vertex' motion, the weights learn it. The motion model pays where pieces
// move that have few neighbours each: with one connected surface, finding regions is not worth the
// time, which is most of the encoder's.
bool SequenceEncoder::regions_may_pay() const {
  if (tools_.regions == RegionUse::kReebGraph) return false;
  if (effort_.region_trials) return true;
  if (tools_.regions == RegionUse::kThorough) return false;
  return std::any_of(sequence_.shots.begin(), sequence_.shots.end(), [](const Shot& shot) {
    return largest_piece(shot.connectivity) <= kWholeSurface;
  });
}

Status SequenceEncoder::choose_regions() {
  if (options_.regions >= 0 || !regions_may_pay()) return {};
  for (const uint32_t candidate : kRegionCandidates) {
    Settings settings = best_.settings;
    for (ShotSettings& s : settings) s.regions = candidate;
    bool kept = false;
    if (Status s = try_settings(settings, kept); !s.ok()) return s;
    if (!kept) break;
  }
  return {};
}

Status SequenceEncoder::choose_prior() {
  if (!tools_.learns || !effort_.weak_prior_trial) return {};
  Settings settings = best_.settings;
  for (ShotSettings& s : settings) s.weak_prior = true;
  bool kept = false;
  return try_settings(settings, kept);
}

ErrorSums SequenceEncoder::measure(const Attempt& a) const {
  ErrorSums sums;
  for (size_t i = 0; i < shots_.size(); ++i) {
    sums.add(shots_[i]->measure(a.shots[i]));
  }
  return sums;
}

EncodeStats SequenceEncoder::stats() const {
  const ErrorSums sums = measure(best_);
  EncodeStats out = size_stats(best_.bytes, vertex_frames_);
  out.kg = kg_error(sums.squared, energy_of(sequence_));
  out.rmse = std::sqrt(sums.squared / vertex_frames_);
  out.max_error = sums.largest;
  for (const CodedShot& shot : best_.shots) {
    if (shot.regions > 0)
      out.notes.push_back("motion model with " + std::to_string(shot.regions) + " regions");
  }
  return out;
}

double SequenceEncoder::first_error() const {
  const double extent = std::sqrt(energy_ / std::max(1.0, 3 * vertex_frames_));
  if (options_.target == Target::kKg) return options_.target_value / 100 * extent;
  return bounded() ? options_.target_value / kBoundPerError : kGuessedPrecision * extent;
}

SequenceEncoder::Settings SequenceEncoder::first_settings() const {
  ShotSettings common = {.plain = tools_.plain_mesh, .components = {}};
  if (options_.regions > 0) common.regions = static_cast<uint32_t>(options_.regions);
  if (options_.regions < 0 && tools_.regions == RegionUse::kReebGraph)
    common.regions = ShotSettings::kReebRegions;
  return with_grids(Settings(shots_.size(), common), first_error());
}

Status SequenceEncoder::start() {
  Settings settings = first_settings();
  if (bounded()) {
    const auto frames = static_cast<double>(sequence_.frame_count());
    const double q = energy_ > 0 ? 2 * first_error() * std::sqrt(frames) : kAnyStep;
    return attempt(settings, std::clamp(q, least_step(), kMaxStep), best_);
  }
  if (Status s = prepare(settings); !s.ok()) return s;
  double q = guess_step(settings);
  if (!is_error(options_.target)) {
    // Grids that suit the error which that size leads to leave more, or less, to the rest.
    const double error = std::sqrt(expect(settings, q).distortion / (3 * vertex_frames_));
    settings = with_grids(settings, error);
    if (Status s = prepare(settings); !s.ok()) return s;
    q = guess_step(settings);
  }
  return attempt(settings, q, best_);
}

Status SequenceEncoder::suit_grids() {
  const Settings settings = with_grids(best_.settings, coordinate_error());
  return settings == best_.settings ? Status() : attempt(settings, best_.q, best_);
}

Status SequenceEncoder::run(std::vector<uint8_t>& out, EncodeStats& stats, bool& missed) {
  missed = false;
  if (Status s = start(); !s.ok()) return s;
  if (bounded()) {
    if (Status s = search_base(); !s.ok()) return s;
  } else if (Status s = search(kNear, 2 * kNear, kRoughTrials); !s.ok()) {
    return s;
  }
  hold_components(!bounded());
  if (!is_error(options_.target)) {
    if (Status s = suit_grids(); !s.ok()) return s;
  }
  if (Status s = refine_grids(); !s.ok()) return s;
  if (Status s = choose_meshes(); !s.ok()) return s;
  if (Status s = choose_regions(); !s.ok()) return s;
  if (Status s = choose_prior(); !s.ok()) return s;
  if (Status s = finish_search(); !s.ok()) return s;
  stats = this->stats();
  const bool fell_short = stats.kg > options_.target_value;
  if (options_.target == Target::kKg && fell_short != (best_.excess > 0)) {
    exact_ = true;  // so little error is asked for that rounding to binary32 counts, for or against
    best_.excess = excess_of(best_);
    if (Status s = finish_search(); !s.ok()) return s;
    stats = this->stats();
  }
  missed = best_.excess > 0 || (bounded() && stats.max_error > options_.target_value);
  if (missed) return unreachable(stats);
  out = std::move(best_.bytes);
  return {};
}

}  // namespace reeb
