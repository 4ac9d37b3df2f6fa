#include "codec/enc/attributes/normal_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "codec/dec/attributes/computed_normals.h"
#include "codec/enc/attributes/integer_encoder.h"
#include "entropy/interval_coder.h"

namespace reeb {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kStepPerRadian = 1.4;    ///< steps next to the tip of the octahedron
constexpr int kFinerSteps = 5;            ///< halvings, for the rest of it
constexpr double kRadiansPerError = 4.3;  ///< anywhere on it: sqrt(6) * sqrt(3), a little more
constexpr double kLeastForCoding = 0.25;  ///< of the angle, what corners of a wedge leave

/// Angles between normals, compared with the largest that is allowed.
class AngleTest {
 public:
  explicit AngleTest(double degrees) : cosine_(std::cos(degrees * kRadians)) {}

  bool within(const float* a, const float* b) const {
    double dot = 0, aa = 0, bb = 0;
    for (int i = 0; i < 3; ++i) {
      const auto x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
      dot += x * y;
      aa += x * x;
      bb += y * y;
    }
    return aa > 0 && bb > 0 ? dot >= cosine_ * std::sqrt(aa * bb) : aa == bb;
  }

 private:
  double cosine_;
};

double dot(const Direction& a, const Direction& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool finite(std::span<const float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); });
}

/// The normals of an attribute on one choice of wedges.
class NormalChoice {
 public:
  NormalChoice(const Attribute& attribute, const ShotSurface& surface, uint32_t frame_count,
               const FramePositions& positions)
      : attribute_(attribute),
        surface_(surface),
        frame_count_(frame_count),
        positions_(positions),
        normals_(attribute.values.size() / sizeof(float)),
        frames_(attribute.animated ? frame_count : 1),
        elements_(normals_.size() / 3 / std::max(frames_, 1u)) {
    if (!normals_.empty())
      std::memcpy(normals_.data(), attribute.values.data(), attribute.values.size());
  }

  bool usable() const { return finite(normals_); }

  /// As they are computed; false where one is too far off.
  bool plain(ComputedNormals& out);
  /// Turned; false where that is impossible.
  bool turned(ComputedNormals& out);

 private:
  const float* normal(uint32_t t, size_t element) const {
    return &normals_[(t * elements_ + element) * 3];
  }
  void find_sites(double degrees, IntervalEncoder& coder, Sites& sites) const;
  void find_corrections(const Sites& sites, double degrees);
  bool within(const Sites& sites, double degrees, std::span<const float> corrections,
              bool every_frame) const;
  bool code_still(const Sites& sites, IntervalEncoder& coder, ComputedNormals& out) const;
  bool choose_turning(Sites sites, IntervalEncoder& coder, ComputedNormals& out) const;

  const Attribute& attribute_;
  const ShotSurface& surface_;
  const uint32_t frame_count_;
  const FramePositions& positions_;
  std::vector<float> normals_;
  const uint32_t frames_;
  const size_t elements_;
  std::vector<float> corrections_;  ///< [frame][site][u, v]
  std::vector<bool> needed_;        ///< of a site, in some frame
};

void NormalChoice::find_sites(double degrees, IntervalEncoder& coder, Sites& sites) const {
  const AngleTest test(degrees);
  sites = code_sites(coder, attribute_.domain, surface_, [&](uint32_t a, uint32_t b) {
    for (uint32_t t = 0; t < frames_; ++t) {
      if (!test.within(normal(t, a), normal(t, b))) return true;
    }
    return false;
  });
}

bool NormalChoice::plain(ComputedNormals& out) {
  IntervalEncoder coder;
  Sites sites;
  find_sites(attribute_.max_angle, coder, sites);
  const AngleTest test(attribute_.max_angle);
  for (uint32_t t = 0; t < frames_; ++t) {
    const std::vector<float> computed = computed_normals(sites.mesh, positions_(t));
    for (size_t e = 0; e < elements_; ++e) {
      if (!test.within(&computed[size_t{3} * sites.site(e)], normal(t, e))) return false;
    }
  }
  out.coded.section = coder.finish();
  return true;
}

// Of each site the mean of its elements, relative to the axes there; 0 where what is computed is
// so near to all of them.
void NormalChoice::find_corrections(const Sites& sites, double degrees) {
  const AngleTest test(degrees);
  corrections_.assign(size_t{2} * frames_ * sites.mesh.count, 0);
  needed_.assign(sites.mesh.count, false);
  for (uint32_t t = 0; t < frames_; ++t) {
    const std::vector<NormalFrame> axes = normal_frames(sites.mesh, positions_(t));
    std::vector<Direction> sums(sites.mesh.count);
    for (size_t e = 0; e < elements_; ++e) {
      const uint32_t site = sites.site(e);
      const float* n = normal(t, e);
      const Direction wanted{double{n[0]}, double{n[1]}, double{n[2]}};
      const double length = std::sqrt(dot(wanted, wanted));
      if (!test.within(axes[site].turned(0, 0).data(), n)) needed_[site] = true;
      for (size_t a = 0; a < 3 && length > 0; ++a) sums[site][a] += wanted[a] / length;
    }
    for (size_t s = 0; s < sites.mesh.count; ++s) {
      const NormalFrame& f = axes[s];
      const Direction local{dot(sums[s], f.along), dot(sums[s], f.across), dot(sums[s], f.normal)};
      if (dot(local, local) == 0) continue;
      const auto uv = to_octahedron(local);
      for (size_t k = 0; k < 2; ++k)
        corrections_[(t * sites.mesh.count + s) * 2 + k] = static_cast<float>(uv[k]);
    }
  }
  for (size_t i = 0; i < corrections_.size(); ++i) {
    if (!needed_[i / 2 % sites.mesh.count]) corrections_[i] = 0;
  }
}

/// Whether elements of sites that need it are so near; `corrections`: of every frame, or of all.
bool NormalChoice::within(const Sites& sites, double degrees, std::span<const float> corrections,
                          bool every_frame) const {
  const AngleTest test(degrees);
  const size_t frame = size_t{2} * sites.mesh.count;
  for (uint32_t t = 0; t < frames_; ++t) {
    const std::vector<float> turned =
        turned_normals(sites.mesh, positions_(t), corrections.subspan(every_frame ? t * frame : 0));
    for (size_t e = 0; e < elements_; ++e) {
      const uint32_t site = sites.site(e);
      if (needed_[site] && !test.within(&turned[size_t{3} * site], normal(t, e))) return false;
    }
  }
  return true;
}

// The same in all frames: the mean.
bool NormalChoice::code_still(const Sites& sites, IntervalEncoder& coder,
                              ComputedNormals& out) const {
  const size_t count = size_t{2} * sites.mesh.count;
  if (count == 0) return false;
  std::vector<double> means(count);
  for (size_t i = 0; i < corrections_.size(); ++i)
    means[i % count] += double{corrections_[i]} / frames_;
  double step = attribute_.corrected_angle * kRadians * kStepPerRadian;
  for (int i = 0; i <= kFinerSteps; ++i, step /= 2) {
    std::vector<int64_t> multiples(count);
    std::vector<float> rounded(count);
    for (size_t k = 0; k < count; ++k) {
      multiples[k] = static_cast<int64_t>(std::floor(means[k] / step + 0.5));
      rounded[k] = static_cast<float>(static_cast<double>(multiples[k]) * step);
    }
    if (!within(sites, attribute_.corrected_angle, rounded, false)) continue;
    const auto [low, high] = std::minmax_element(multiples.begin(), multiples.end());
    std::vector<uint32_t> integers(count);
    for (size_t k = 0; k < count; ++k) integers[k] = static_cast<uint32_t>(multiples[k] - *low);
    ChannelHeader channel;
    channel.step = step;
    channel.set_low(*low);
    channel.top = static_cast<uint64_t>(*high - *low);
    out.coded.body.channels = {channel, channel};
    return encode_integers(out.coded.header, out.coded.body, surface_, sites.mesh, integers, coder)
        .ok();
  }
  return false;
}

// Others in every frame: an attribute of its own, whose errors leave room for those of the means.
bool NormalChoice::choose_turning(Sites sites, IntervalEncoder& coder, ComputedNormals& out) const {
  if (frames_ != frame_count_) return false;
  double left = 1;
  do {
    left -= kLeastForCoding;
    if (left < kLeastForCoding) return false;
  } while (!within(sites, attribute_.corrected_angle * (1 - left), corrections_, true));
  out.coded.header.flags |= AttributeHeader::kTurning;
  Attribute& a = out.corrections;
  a = attribute_;
  a.channel_count = 2;
  a.max_error.assign(2, attribute_.corrected_angle * kRadians * left / kRadiansPerError);
  std::vector<float> values;
  for (uint32_t t = 0; t < frames_; ++t) {
    for (size_t e = 0; e < elements_; ++e) {
      const float* uv = &corrections_[(size_t{t} * sites.mesh.count + sites.site(e)) * 2];
      values.insert(values.end(), uv, uv + 2);
    }
  }
  a.assign(std::span<const float>(values));
  out.coded.section = coder.finish();
  out.sites = std::move(sites);
  return true;
}

bool NormalChoice::turned(ComputedNormals& out) {
  if (!(attribute_.corrected_angle > 0)) return false;
  IntervalEncoder coder;
  Sites sites;
  find_sites(std::min(attribute_.max_angle, attribute_.corrected_angle / 2), coder, sites);
  find_corrections(sites, attribute_.max_angle);
  out.coded.header.flags |= AttributeHeader::kCorrected;
  if (code_still(sites, coder, out)) {
    out.coded.section = coder.finish();
    return true;
  }
  // What turns errs in every frame, also where it stands for 0.
  find_corrections(sites, std::max(attribute_.max_angle - attribute_.corrected_angle, 0.0));
  return choose_turning(std::move(sites), coder, out);
}

}  // namespace

bool compute_normals(const Attribute& attribute, const ShotSurface& surface, uint32_t frame_count,
                     const FramePositions& positions, ComputedNormals& out) {
  out = {};
  out.coded.header = header_of(attribute);
  if (!(attribute.max_angle > 0) || !out.coded.header.may_be_computed()) return false;
  NormalChoice choice(attribute, surface, frame_count, positions);
  if (!choice.usable()) return false;
  out.coded.header.flags = AttributeHeader::kAnimated | AttributeHeader::kComputed;
  return choice.plain(out) || choice.turned(out);
}

}  // namespace reeb
