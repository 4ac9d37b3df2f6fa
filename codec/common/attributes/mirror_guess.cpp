#include "codec/common/attributes/mirror_guess.h"

#include <algorithm>
#include <cmath>

namespace reeb {

namespace {

constexpr uint32_t kNone = MirrorSites::kNone;
constexpr double kMinScale = 0.3;
constexpr int kMaxTurning = 8;

}  // namespace

MirrorGuess::MirrorGuess(const SiteMesh& sites, const MeshWalk& walk, size_t channels, bool planar,
                         const std::optional<MirrorPlane>& plane)
    : walk_(walk), channels_(channels), planar_(planar) {
  if (!plane) return;
  pairs_.emplace(sites, *plane);
  moved_.resize(channels);
  turn_.resize(sites.count);
  uint32_t anchors = 0;
  for (uint32_t t = 0; t < sites.count; ++t) {
    turn_[walk.order[t]] = t;
    anchors = std::max(anchors, pairs_->anchor(t) + 1);
  }
  latest_.assign(anchors, kNone);
}

bool MirrorGuess::is_known(const Sites& sites) const {
  return std::all_of(sites.begin(), sites.end(),
                     [&](uint32_t s) { return turn_[s] < turn_[site_]; });
}

void MirrorGuess::start(uint32_t turn, std::span<const uint32_t> values) {
  if (!pairs_) return;
  values_ = values;
  site_ = walk_.order[turn];
  has_triangle_ = missed_ = false;
  last_error_ = error_sum_ = 0;
  const uint32_t partner = pairs_->partner(site_);
  same_ = partner == kNone ? kNone : latest_[partner];
  for (const KnownTriangle& t : walk_.triangles(turn)) {
    own_ = {walk_.order[t.a], walk_.order[t.b], site_};
    Sites there;
    if (!pairs_->find(own_, there) || !is_known(there)) continue;
    same_ = there[2];
    has_triangle_ = planar_ ? turn_over(there, own_) : move(there, own_);
    break;
  }
}

// The step from either end of the edge to the corner is the same.
bool MirrorGuess::move(const Sites& from, const Sites& to) {
  for (size_t k = planar_ ? 2 : 0; k < channels_; ++k) {
    const double corner = value(from[2], k);
    moved_[k] = (corner - value(from[0], k) + value(to[0], k) + corner - value(from[1], k) +
                 value(to[1], k)) /
                2;
  }
  return true;
}

// The triangle has the same shape, as it is or turned over.
bool MirrorGuess::turn_over(const Sites& from, const Sites& to) {
  const double u = value(from[0], 0), v = value(from[0], 1);
  const double du = value(from[1], 0) - u, dv = value(from[1], 1) - v;
  const double x = value(from[2], 0) - u, y = value(from[2], 1) - v;
  const double edge2 = du * du + dv * dv;
  if (edge2 == 0) return false;
  const double along = (x * du + y * dv) / edge2;
  beside_ = (y * du - x * dv) / edge2;
  const double side = turning_ >= 0 ? beside_ : -beside_;
  const double own_u = value(to[0], 0), own_v = value(to[0], 1);
  const double own_du = value(to[1], 0) - own_u, own_dv = value(to[1], 1) - own_v;
  moved_[0] = own_u + along * own_du - side * own_dv;
  moved_[1] = own_v + along * own_dv + side * own_du;
  return move(from, to);
}

double MirrorGuess::scale(size_t channel) const {
  return kMinScale + (channel == 0 ? error_ : (error_ + last_error_) / 2);
}

void MirrorGuess::learn(size_t channel, uint32_t value) {
  if (!pairs_) return;
  missed_ = missed_ || (same_ != kNone && values_[same_ * channels_ + channel] != value);
  if (has_triangle_) {
    last_error_ = std::abs(value - moved_[channel]);
    error_sum_ += last_error_;
  }
  if (channel + 1 == channels_) finish();
}

void MirrorGuess::finish() {
  latest_[pairs_->anchor(site_)] = site_;
  if (!has_triangle_) return;
  error_ = (7 * error_ + error_sum_ / static_cast<double>(channels_)) / 8;
  if (!planar_) return;
  const double u = value(own_[0], 0), v = value(own_[0], 1);
  const double area = (value(own_[1], 0) - u) * (value(site_, 1) - v) -
                      (value(own_[1], 1) - v) * (value(site_, 0) - u);
  if (area * beside_ != 0)
    turning_ = std::clamp(turning_ + (area * beside_ > 0 ? 1 : -1), -kMaxTurning, kMaxTurning);
}

}  // namespace reeb
