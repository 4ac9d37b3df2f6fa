#include "codec/common/attributes/value_predictor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {

namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
constexpr double kMinScale = 0.3;  // of an integer; rounding alone makes about that
constexpr double kMaxBeside = 8;   // a sliver across says little
constexpr int kMaxTurning = 8;
constexpr size_t kSingleTips = 2;

// Kinds of guesses; each is kept apart by what is known around the site.
enum Kind : uint32_t {
  kFitted,
  kFittedBySpread,
  kShifted,
  kBase,
  kConformal,
  kAffine,
  kTip,
  kSame,
  kSibling,
  kMiddle,
  kMirrored,
  kMirrorSame
};

void add_guess(uint32_t kind, double place, double scale, GuessMixture& out) {
  const auto fixed_place = static_cast<int64_t>(std::floor(place * 256 + 0.5));
  const auto fixed_scale = static_cast<uint32_t>(std::clamp(scale * 256, 64.0, 16777216.0));
  out.add(kind, fixed_place + 128, fixed_scale);
}

}  // namespace

ValuePredictor::ValuePredictor(const SiteMesh& sites, const MeshWalk& walk,
                               std::vector<uint32_t> tops, bool texture,
                               const std::optional<MirrorPlane>& plane)
    : sites_(sites),
      walk_(walk),
      tops_(std::move(tops)),
      texture_(texture && tops_.size() >= 2),
      mirror_(sites, walk, tops_.size(), texture_, plane),
      error_(sites.count),
      last_(kNone),
      channels_(tops_.size()),
      coded_(tops_.size()) {
  if (sites.vertex.empty()) return;
  sibling_.assign(*std::max_element(sites.vertex.begin(), sites.vertex.end()) + size_t{1}, kNone);
}

// Grid points are integers, so that dot products are exact.
ValuePredictor::Unfolded ValuePredictor::unfold(const KnownTriangle& triangle) const {
  Unfolded out{walk_.order[triangle.a], walk_.order[triangle.b],
               triangle.across == kNoTurn ? kNone : walk_.order[triangle.across]};
  const auto at = [&](uint32_t site, size_t axis) {
    return static_cast<double>(sites_.grid[size_t{site} * 3 + axis]);
  };
  double edge2 = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double d = at(out.b, i) - at(out.a, i);
    edge2 += d * d;
  }
  out.flat = edge2 == 0;
  const auto place = [&](uint32_t site, double& along, double& beside) {
    double dot = 0, length2 = 0;
    for (size_t i = 0; i < 3; ++i) {
      const double d = at(site, i) - at(out.a, i);
      dot += d * (at(out.b, i) - at(out.a, i));
      length2 += d * d;
    }
    along = dot / edge2;
    beside = std::sqrt(std::max(length2 / edge2 - along * along, 0.0));
  };
  if (out.flat) return out;
  place(site_, out.along, out.beside);
  if (out.across != kNone) place(out.across, out.across_along, out.across_beside);
  return out;
}

// Which side of the edge the site is on, on the texture: left (1) or right (-1).
double ValuePredictor::turning_of(const Unfolded& t) const {
  if (t.across != kNone) {
    double d[2][2];
    for (size_t i = 0; i < 2; ++i) {
      const double from = value(t.a, i);
      d[0][i] = value(t.b, i) - from;
      d[1][i] = value(t.across, i) - from;
    }
    const double area = d[0][0] * d[1][1] - d[0][1] * d[1][0];
    if (area != 0) return area > 0 ? -1 : 1;
  }
  return turning_ >= 0 ? 1 : -1;
}

// The triangle on the texture has the shape that it has in space.
void ValuePredictor::add_conformal(const Unfolded& t) {
  const double side = turning_of(t) * t.beside;
  const double u = value(t.a, 0), v = value(t.a, 1);
  const double du = value(t.b, 0) - u, dv = value(t.b, 1) - v;
  channels_[0].conformal += u + t.along * du - side * dv;
  channels_[1].conformal += v + t.along * dv + side * du;
}

void ValuePredictor::add(const Unfolded& t) {
  const bool tip = t.across != kNone;
  const bool unfolds = tip && !t.flat && t.across_beside > 0;
  const double ratio = unfolds ? std::min(t.beside / t.across_beside, kMaxBeside) : 0;
  for (size_t k = 0; k < channels_.size(); ++k) {
    Channel& c = channels_[k];
    const double a = value(t.a, k), b = value(t.b, k);
    c.mean += (a + b) / 2;
    const double foot = a + t.along * (b - a);
    if (!tip) {
      c.affine += t.flat ? (a + b) / 2 : foot;
      continue;
    }
    const double x = value(t.across, k);
    const double parallelogram = a + b - x;
    c.tips += parallelogram;
    c.squares += parallelogram * parallelogram;
    c.affine += unfolds ? foot - ratio * (x - a - t.across_along * (b - a)) : parallelogram;
  }
  if (tip) ++tips_;
  if (texture_) add_conformal(t);
  neighbour_error_ += static_cast<double>(error_[t.a]) + static_cast<double>(error_[t.b]);
}

void ValuePredictor::add_candidate(uint32_t site, bool sibling) {
  if (site == kNone || candidates_.size() == 6) return;
  for (const Candidate& c : candidates_) {
    bool same = true;
    for (size_t k = 0; k < channels_.size(); ++k) same = same && value(c.site, k) == value(site, k);
    if (same) return;
  }
  candidates_.push_back({site, sibling, false});
}

void ValuePredictor::find_candidates() {
  candidates_.resize(0);
  if (!sibling_.empty()) add_candidate(sibling_[sites_.vertex[site_]], true);
  for (size_t i = 0; i < std::min<size_t>(triangles_.size(), 2); ++i) {
    add_candidate(triangles_[i].a, false);
    add_candidate(triangles_[i].b, false);
  }
  if (triangles_.empty()) add_candidate(last_, false);
}

void ValuePredictor::set_base(Channel& c, size_t k) const {
  const auto count = static_cast<double>(triangles_.size());
  if (triangles_.empty()) {
    const uint32_t near = candidates_.empty() ? kNone : candidates_[0].site;
    c.base = near == kNone ? tops_[k] / 2.0 : value(near, k);
    c.features = {};
    c.spread = kMinScale;
    return;
  }
  c.mean /= count;
  c.affine /= count;
  c.conformal /= count;
  c.base = tips_ > 0 ? c.tips / tips_ : c.mean;
  const bool planar = texture_ && k < 2;
  c.features = {c.mean - c.base, planar ? c.conformal - c.base : 0, c.affine - c.base};
  const double square = tips_ > 0 ? c.squares / tips_ - c.base * c.base : 0;
  c.spread = kMinScale + 0.7 * std::sqrt(std::max(square, 0.0));
}

void ValuePredictor::start(uint32_t turn, std::span<const uint32_t> values) {
  values_ = values;
  site_ = walk_.order[turn];
  triangles_.resize(0);
  tips_ = 0;
  neighbour_error_ = error_sum_ = shift_ = 0;
  for (Channel& c : channels_) c = {};
  for (const KnownTriangle& t : walk_.triangles(turn)) triangles_.push_back(unfold(t));
  for (const Unfolded& t : triangles_) add(t);
  if (!triangles_.empty()) neighbour_error_ /= 2 * static_cast<double>(triangles_.size());
  find_candidates();
  mirror_.start(turn, values);
  const FeatureWeights::Row w = weights_[std::min(tips_, 3u)].solve();
  for (size_t k = 0; k < channels_.size(); ++k) {
    Channel& c = channels_[k];
    set_base(c, k);
    c.fitted = c.base;
    for (size_t i = 0; i < w.size(); ++i) c.fitted += w[i] * c.features[i];
    c.fitted = std::clamp(c.fitted, 0.0, static_cast<double>(tops_[k]));
  }
}

double ValuePredictor::scale(size_t channel) const {
  const double of_neighbours = neighbour_error_ + kMinScale;
  if (channel == 0) return of_neighbours;
  const double mean = error_sum_ / static_cast<double>(channel);
  return std::max((2 * of_neighbours + mean) / 3, kMinScale);
}

uint32_t ValuePredictor::likely(size_t channel) const {
  return static_cast<uint32_t>(std::floor(channels_[channel].fitted + 0.5));
}

uint32_t ValuePredictor::reach(size_t channel) const {
  return 1 + static_cast<uint32_t>(std::min(scale(channel), 1000.0));
}

void ValuePredictor::guess_mirrored(size_t channel, GuessMixture& out) const {
  if (mirror_.same() != kNone) {
    const uint32_t so_far = channel == 0 ? 0 : mirror_.missed() ? 2 : 1;
    add_guess(kMirrorSame * kSituations + so_far, value(mirror_.same(), channel), kMinScale, out);
  }
  if (!mirror_.has_triangle()) return;
  const double place = std::clamp(mirror_.moved(channel), 0.0, static_cast<double>(tops_[channel]));
  add_guess(kMirrored * kSituations + situation(), place, mirror_.scale(channel), out);
}

uint32_t ValuePredictor::situation() const {
  return tips_ > 0 ? 1 + std::min(tips_, 3u) : (triangles_.empty() ? 0 : 1);
}

void ValuePredictor::guess(size_t channel, GuessMixture& out) const {
  out.clear();
  const auto kind = [&](Kind k) { return k * kSituations + situation(); };
  const double scale = this->scale(channel);
  const Channel& c = channels_[channel];
  for (const Candidate& near : candidates_) {
    const uint32_t so_far = channel == 0 ? 0 : near.missed ? 2 : 1;
    add_guess((near.sibling ? kSibling : kSame) * kSituations + so_far, value(near.site, channel),
              kMinScale, out);
  }
  guess_mirrored(channel, out);
  if (triangles_.empty()) {
    add_guess(kind(kBase), c.base, scale, out);
    add_guess(kind(kMiddle), tops_[channel] / 2.0, tops_[channel] / 4.0 + kMinScale, out);
    return;
  }
  const double top = tops_[channel];
  add_guess(kind(kFitted), c.fitted, scale, out);
  if (channel > 0) add_guess(kind(kShifted), std::clamp(c.fitted + shift_, 0.0, top), scale, out);
  if (tips_ < 2) add_guess(kind(kBase), std::clamp(c.base, 0.0, top), scale, out);
  if (tips_ > 0) add_guess(kind(kAffine), std::clamp(c.affine, 0.0, top), scale, out);
  if (texture_ && channel < 2)
    add_guess(kind(kConformal), std::clamp(c.conformal, 0.0, top), scale, out);
  if (tips_ < 2) return;
  add_guess(kind(kFittedBySpread), c.fitted, c.spread, out);
  size_t tips = 0;
  for (const Unfolded& t : triangles_) {
    if (t.across == kNone || tips++ >= kSingleTips) continue;
    const double tip = static_cast<double>(value(t.a, channel)) + value(t.b, channel) -
                       static_cast<double>(value(t.across, channel));
    add_guess(kind(kTip), std::clamp(tip, 0.0, top), scale, out);
  }
}

void ValuePredictor::learn(size_t channel, uint32_t value) {
  const Channel& c = channels_[channel];
  coded_[channel] = value;
  shift_ = value - c.fitted;
  error_sum_ += std::abs(shift_);
  if (!triangles_.empty()) {
    // Outliers count little.
    const double confidence =
        1 / (kMinScale + neighbour_error_ * neighbour_error_ + shift_ * shift_);
    weights_[std::min(tips_, 3u)].learn(c.features, value - c.base, confidence);
  }
  for (Candidate& near : candidates_)
    near.missed = near.missed || this->value(near.site, channel) != value;
  mirror_.learn(channel, value);
  if (channel + 1 == channels_.size()) finish();
}

void ValuePredictor::finish() {
  error_[site_] = static_cast<float>(error_sum_ / static_cast<double>(channels_.size()));
  last_ = site_;
  if (!sibling_.empty()) sibling_[sites_.vertex[site_]] = site_;
  if (!texture_ || triangles_.empty()) return;
  const Unfolded& t = triangles_[0];
  const double u = value(t.a, 0), v = value(t.a, 1);
  const double area = (value(t.b, 0) - u) * (coded_[1] - v) - (value(t.b, 1) - v) * (coded_[0] - u);
  if (area != 0) turning_ = std::clamp(turning_ + (area > 0 ? 1 : -1), -kMaxTurning, kMaxTurning);
}

}  // namespace reeb
