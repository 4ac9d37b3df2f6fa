#include "codec/enc/sequence_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/common/coding_tools.h"
#include "codec/common/parallel.h"
#include "codec/enc/step_search.h"

namespace reeb {

namespace {

constexpr double kGridPerError =
    2.0;  ///< first guess of the grid step, in RMS errors per coordinate
constexpr double kGuessedPrecision =
    2e-4;  ///< of the extent: error expected where the target is a size
constexpr double kMostSteps = 1 << 24;  ///< of a coefficient; binary32 keeps no more
constexpr double kRoughTolerance = 0.05;
constexpr double kTolerance = 0.008;
constexpr int kRoughTrials = 6;
constexpr int kTrials = 10;
constexpr double kBoundPerError = 2.5;  ///< guess of the bound on corrected errors, in RMS errors
constexpr double kBaseRatio = 1.35;     ///< between the steps tried under corrections
constexpr int kBaseTrials = 7;
constexpr uint32_t kRegionCandidates[] = {12, 40};

bool is_error(Target target) { return target == Target::kKg || target == Target::kMaxError; }

std::vector<MetadataEntry> metadata_of(const Sequence& sequence) {
  std::vector<MetadataEntry> out;
  for (const auto& [key, value] : sequence.metadata) out.push_back({key, value});
  return out;
}

/// The nearest that the search came to a target that it did not meet.
Status unreachable(const EncodeStats& nearest) {
  return Status::invalid("the target is out of reach; nearest: KG " + std::to_string(nearest.kg) +
                         " %, largest error " + std::to_string(nearest.max_error) + ", " +
                         std::to_string(nearest.bytes) + " bytes");
}

}  // namespace

SequenceEncoder::SequenceEncoder(const Sequence& sequence, const EncodeOptions& options)
    : sequence_(sequence), options_(options) {
  uint32_t first_frame = 0;
  for (const Shot& shot : sequence.shots) {
    shots_.push_back(std::make_unique<ShotEncoder>(shot, first_frame, options,
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
  return energy_ > 0 ? 100 * std::sqrt(squared_error / energy_) : 0;
}

double SequenceEncoder::excess_of(const Attempt& a) const {
  double measured = 0;
  switch (options_.target) {
    case Target::kKg:
      measured = kg_of(exact_ ? measure(a).squared : a.squared_error);
      break;
    case Target::kMaxError:
      return 0;  // whatever the step
    case Target::kBpvf:
      measured = 8 * static_cast<double>(a.bytes.size()) / vertex_frames_;
      break;
    case Target::kSize:
      measured = static_cast<double>(a.bytes.size());
      break;
    case Target::kLossless:  // see encode_lossless
      break;
  }
  return measured > 0 ? std::log(measured / options_.target_value) : -1e3;
}

Status SequenceEncoder::attempt(double q, Attempt& out) {
  out = {};
  out.q = q;
  ContainerWriter writer(out.bytes);
  SequenceHeader header;
  header.total_frames = sequence_.frame_count();
  header.shot_count = static_cast<uint32_t>(shots_.size());
  header.frame_rate = sequence_.frame_rate;
  header.start_time = sequence_.start_time;
  if (Status s = writer.begin(header); !s.ok()) return s;
  if (Status s = writer.metadata(metadata_of(sequence_)); !s.ok()) return s;
  for (uint32_t i = 0; i < shots_.size(); ++i) {
    const std::vector<CodedGroup>& groups = out.shots.emplace_back(shots_[i]->encode(q));
    for (const CodedGroup& g : groups) out.squared_error += g.squared_error;
    if (Status s = shots_[i]->write(i, groups, writer); !s.ok()) return s;
  }
  if (Status s = writer.finish(); !s.ok()) return s;
  out.excess = excess_of(out);
  if (!advance(done_ + (1 - done_) * 0.15))
    return {StatusCode::kCancelled, "encoding was cancelled"};
  return {};
}

Status SequenceEncoder::search(double tolerance, int max_trials) {
  Status status;
  std::vector<Attempt> attempts;
  const StepSearchOptions search_options{is_error(options_.target), tolerance, max_trials,
                                         least_step()};
  const StepTrial found = search_step(best_.q, search_options, [&](double q) {
    Attempt a;
    if (status.ok()) status = attempt(q, a);
    attempts.push_back(std::move(a));
    return status.ok() ? attempts.back().excess : 0;
  });
  if (!status.ok()) return status;
  for (Attempt& a : attempts) {
    if (a.q != found.q) continue;
    for (const Attempt& other : attempts) {
      const double bits =
          8 * (static_cast<double>(a.bytes.size()) - static_cast<double>(other.bytes.size()));
      if (std::abs(bits) > 64)
        slope_ = std::max(0.0, (other.squared_error - a.squared_error) / bits);
    }
    best_ = std::move(a);
    break;
  }
  return {};
}

// The reconstruction underneath may be rough, since corrections bound the error whatever it is: the
// best one makes the smallest file.
Status SequenceEncoder::search_base() {
  Attempt first;
  if (Status s = attempt(best_.q, first); !s.ok()) return s;
  const double rms = std::sqrt(first.squared_error / (3 * vertex_frames_));
  const double wanted = options_.target_value / kBoundPerError;
  const double scale = rms > 0 ? std::clamp(wanted / rms, 0.1, 10.0) : 1.0;
  const double q0 = std::max(best_.q * scale, least_step());
  best_ = std::move(first);
  Status status;
  search_least(q0, kBaseRatio, kBaseTrials, [&](double q) {
    Attempt a;
    if (status.ok()) status = attempt(q, a);
    if (!status.ok()) return 0.0;
    const auto size = static_cast<double>(a.bytes.size());
    if (a.bytes.size() < best_.bytes.size()) best_ = std::move(a);
    return size;
  });
  return status;
}

double SequenceEncoder::least_step() const {
  double largest = 0;
  for (const auto& shot : shots_) largest = std::max(largest, shot->largest_coefficient());
  return largest / kMostSteps;
}

double SequenceEncoder::coordinate_error() const {
  return std::sqrt(best_.squared_error / (3 * vertex_frames_));
}

Status SequenceEncoder::set_grids(double error) {
  for (auto& shot : shots_) {
    if (Status s = shot->set_grid(kGridPerError * error); !s.ok()) return s;
  }
  return {};
}

void SequenceEncoder::set_regions(uint32_t count) {
  for (auto& shot : shots_) shot->set_regions(count);
}

Status SequenceEncoder::try_setting(bool& kept) {
  Attempt a;
  if (Status s = attempt(best_.q, a); !s.ok()) return s;
  const double slope = slope_ > 0 ? slope_ : 0.1 * best_.q * best_.q;
  const auto cost = [&](const Attempt& x) {
    return (bounded() ? 0 : x.squared_error) + slope * 8 * static_cast<double>(x.bytes.size());
  };
  kept = cost(a) < cost(best_);
  if (kept) best_ = std::move(a);
  return {};
}

Status SequenceEncoder::refine_grids() {
  if (!uses(coding_tool::kGridTrial)) return {};
  for (const int direction : {-1, 1}) {
    bool moved = false;
    for (bool kept = true; kept;) {
      std::vector<uint32_t> before;
      bool changed = false;
      for (auto& shot : shots_) {
        before.push_back(shot->grid_bits());
        if (Status s = shot->set_grid_bits(before.back() + direction); !s.ok()) return s;
        changed = changed || shot->grid_bits() != before.back();
      }
      kept = false;
      if (changed) {
        if (Status s = try_setting(kept); !s.ok()) return s;
      }
      moved = moved || kept;
      for (size_t i = 0; i < shots_.size() && !kept; ++i) {
        if (Status s = shots_[i]->set_grid_bits(before[i]); !s.ok()) return s;
      }
    }
    if (moved) break;
  }
  return {};
}

Status SequenceEncoder::choose_regions() {
  if (options_.regions >= 0 || options_.profile == Profile::kThesis) return {};
  uint32_t chosen = 0;
  for (const uint32_t candidate : kRegionCandidates) {
    set_regions(candidate);
    bool kept = false;
    if (Status s = try_setting(kept); !s.ok()) return s;
    if (!kept) break;
    chosen = candidate;
  }
  set_regions(chosen);
  return {};
}

ErrorSums SequenceEncoder::measure(const Attempt& a) const {
  ErrorSums sums;
  for (size_t i = 0; i < shots_.size(); ++i) {
    const ErrorSums shot = shots_[i]->measure(a.shots[i]);
    sums.squared += shot.squared;
    sums.largest = std::max(sums.largest, shot.largest);
  }
  return sums;
}

EncodeStats SequenceEncoder::stats() const {
  const ErrorSums sums = measure(best_);
  EncodeStats out;
  out.bytes = best_.bytes.size();
  out.bpvf = 8 * static_cast<double>(out.bytes) / vertex_frames_;
  out.kg = kg_of(sums.squared);
  out.rmse = std::sqrt(sums.squared / vertex_frames_);
  out.max_error = sums.largest;
  ContainerReader container;
  if (container.parse(best_.bytes, Limits{}).ok()) {
    for (const auto& [name, bytes] : container.sections)
      out.sections.push_back({name, 8.0 * static_cast<double>(bytes)});
  }
  for (const auto& shot : shots_) {
    if (shot->regions() > 0)
      out.notes.push_back("motion model with " + std::to_string(shot->regions()) + " regions");
  }
  return out;
}

Status SequenceEncoder::run(std::vector<uint8_t>& out, EncodeStats& stats) {
  const double extent = std::sqrt(energy_ / std::max(1.0, 3 * vertex_frames_));
  double expected = kGuessedPrecision * extent;
  if (options_.target == Target::kKg) expected = options_.target_value / 100 * extent;
  if (bounded()) expected = options_.target_value / kBoundPerError;
  if (Status s = set_grids(expected); !s.ok()) return s;
  if (options_.regions > 0) set_regions(static_cast<uint32_t>(options_.regions));
  if (options_.regions < 0 && options_.profile == Profile::kThesis) {
    for (auto& shot : shots_) shot->set_reeb_regions();
  }

  // A coefficient's error of q/sqrt(12) spreads over the frames; most coefficients are not sent at
  // all.
  best_.q =
      expected > 0 ? 2 * expected * std::sqrt(static_cast<double>(sequence_.frame_count())) : 1e-6;
  if (Status s = bounded() ? search_base() : search(kRoughTolerance, kRoughTrials); !s.ok())
    return s;
  if (!is_error(options_.target)) {
    if (Status s = set_grids(coordinate_error()); !s.ok()) return s;
  }
  if (Status s = refine_grids(); !s.ok()) return s;
  if (Status s = choose_regions(); !s.ok()) return s;
  if (!bounded()) {
    if (Status s = search(kTolerance, kTrials); !s.ok()) return s;
  }
  stats = this->stats();
  if (options_.target == Target::kKg && best_.excess <= 0 && stats.kg > options_.target_value) {
    exact_ = true;  // so little error is asked for that rounding to binary32 counts
    if (Status s = search(kTolerance, kTrials); !s.ok()) return s;
    stats = this->stats();
  }
  const bool missed = bounded() && stats.max_error > options_.target_value;
  if (best_.excess > 0 || missed) return unreachable(stats);
  out = std::move(best_.bytes);
  return {};
}

}  // namespace reeb
