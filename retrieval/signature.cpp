#include "retrieval/signature.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>

#include "retrieval/charts.h"
#include "retrieval/descriptors.h"
#include "retrieval/smoothing.h"
#include "retrieval/stretch.h"
#include "retrieval/thickness.h"
#include "segmentation/piece.h"

namespace reeb::retrieval {
namespace {

static_assert(kProfileLength == kRings && kSpectralValues == kScales * kQuantiles);

constexpr uint32_t kEigenpairs = 60;
constexpr double kSmoothing = 0.0002;  // time over the area
constexpr uint32_t kMaxPieces = 8;
constexpr double kMinPiece = 0.02;       // of the area
constexpr uint32_t kMinVertices = 8;     // of a piece
constexpr double kThicknessLimit = 0.3;  // times the root of the area; a ball has 0.28
constexpr double kMinThickness = 1e-4;   // likewise

float log_of(double value) { return static_cast<float>(std::log(std::max(value, 1e-6))); }

std::vector<float> to_floats(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

void append(const Weighted& values, Weighted& all) {
  all.insert(all.end(), values.begin(), values.end());
}

class Signer {
 public:
  Signer(std::span<const float> positions, std::span<const uint32_t> triangles)
      : pieces_(segmentation::split_pieces(positions, triangles, true)) {}

  Signed run() {
    for (const Surface& surface : pieces_.surfaces) areas_.push_back(total_area(surface));
    area_ = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    if (pieces_.ignored_triangles > 0)
      warn(std::to_string(pieces_.ignored_triangles) + " unusable triangles were ignored");
    if (area_ > 0 && std::isfinite(area_)) {
      sign_pieces(largest_pieces());
    }
    if (spectra_.empty()) {
      warn("no surface that could be signed");
      return std::move(result_);
    }
    describe();
    return std::move(result_);
  }

 private:
  void warn(std::string text) { result_.warnings.push_back(std::move(text)); }

  std::vector<uint32_t> largest_pieces() {
    std::vector<uint32_t> order(areas_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return areas_[a] > areas_[b]; });
    double left_out = 0;
    std::vector<uint32_t> chosen;
    for (const uint32_t p : order) {
      const bool good = chosen.size() < kMaxPieces && areas_[p] >= kMinPiece * area_ &&
                        pieces_.surfaces[p].vertex_count() >= kMinVertices;
      if (good)
        chosen.push_back(p);
      else
        left_out += areas_[p];
    }
    if (left_out > 0.5 * area_)
      warn("of " + std::to_string(order.size()) + " pieces only the " +
           std::to_string(chosen.size()) +
           " largest were signed, less than half of the area; join the pieces of the mesh");
    return chosen;
  }

  // From here on the surface is a smooth one, and so is its area.
  void sign_pieces(const std::vector<uint32_t>& chosen) {
    std::vector<Surface> smooth;
    double area = 0;
    for (const uint32_t p : chosen) {
      smooth.push_back(smoothed(pieces_.surfaces[p], kSmoothing));
      area += total_area(smooth.back());
    }
    if (!(area > 0)) return;
    area_ = area;
    centre_ = area_centre(smooth);
    for (const Surface& surface : smooth) sign_piece(surface);
  }

  void sign_piece(const Surface& surface) {
    const segmentation::Laplacian laplacian = build_laplacian(surface);
    segmentation::Eigenpairs pairs;
    segmentation::PieceResult parts;
    try {
      pairs = smallest_eigenpairs(laplacian, kEigenpairs);
      if (pairs.values.size() < 2 || !pairs.vectors.allFinite() || !(pairs.values[1] > 0)) {
        warn("no spectrum of a piece of " + std::to_string(surface.vertex_count()) + " vertices");
        return;
      }
      if (!analyse(surface, laplacian, pairs, {}, parts)) parts = single_region(surface);
    } catch (const std::exception&) {
      // The eigensolver reports numerical trouble so.
      warn("no spectrum of a piece of " + std::to_string(surface.vertex_count()) + " vertices");
      return;
    }
    const std::vector<double> thickness =
        local_thickness(surface, kThicknessLimit * std::sqrt(area_));
    for (uint32_t v = 0; v < thickness.size(); ++v) {
      const double relative = thickness[v] / std::sqrt(area_);
      thickness_.emplace_back(std::log(std::max(relative, kMinThickness)), laplacian.mass[v]);
    }
    const double unit = std::sqrt(area_);
    append(straightness(surface, laplacian.mass), straightness_);
    append(curvatures(surface, laplacian, centre_, unit), curvature_);
    append(reaches(surface, laplacian.mass, centre_, unit), reach_);
    spectra_.push_back({std::move(pairs), laplacian.mass});
    add_charts(surface, parts.labels, thickness);
  }

  void add_charts(const Surface& surface, const std::vector<uint32_t>& labels,
                  const std::vector<double>& thickness) {
    const Charts charts = cut_charts(surface, labels);
    const size_t first = charts_.size();
    for (size_t c = 0; c < charts.patches.size(); ++c) {
      charts_.push_back(chart_signature(surface, charts.patches[c], thickness));
      neighbours_.emplace_back();
      for (const uint32_t n : charts.neighbours[c]) neighbours_.back().push_back(first + n);
    }
  }

  ChartSignature chart_signature(const Surface& surface, const Patch& patch,
                                 const std::vector<double>& thickness) {
    ChartSignature chart;
    chart.annulus = patch.is_annulus();
    chart.share = static_cast<float>(patch.area / area_);
    chart.area = log_of(patch.area / area_);
    chart.girth = log_of(loop_length(patch.surface, patch.boundaries[0]) / std::sqrt(patch.area));
    Unfolding unfolding;
    if (!unfold(patch, unfolding)) {
      warn("a chart could not be unfolded");
      unfolding.corners.assign(patch.original.size(), Eigen::Matrix<double, 2, 3>::Zero());
    }
    chart.height = chart.annulus ? log_of(unfolding.height) : 0;
    std::vector<double> logs;
    for (const uint32_t t : patch.original) {
      double sum = 0;
      if (t != kNone) {
        for (const uint32_t v : surface.triangles[t])
          sum += std::log(std::max(thickness[v] / std::sqrt(area_), kMinThickness)) / 3;
      }
      logs.push_back(sum);
    }
    const Rings rings = measure_rings(patch, unfolding, logs);
    chart.area_stretch.assign(rings.area.begin(), rings.area.end());
    chart.angle_stretch.assign(rings.angle.begin(), rings.angle.end());
    chart.thickness.assign(rings.value.begin(), rings.value.end());
    return chart;
  }

  void describe() {
    Signature& s = result_.signature;
    s.heat = to_floats(heat_quantiles(spectra_, area_));
    s.wave = to_floats(wave_quantiles(spectra_, area_));
    s.straightness = to_floats(quantiles(std::move(straightness_), kBodyValues));
    s.curvature = to_floats(quantiles(std::move(curvature_), kBodyValues));
    s.reach = to_floats(quantiles(std::move(reach_), kBodyValues));
    const auto middle = static_cast<float>(quantiles(thickness_, 1)[0]);
    s.thickness = to_floats(quantiles(std::move(thickness_), kBodyValues));
    for (ChartSignature& chart : charts_) {
      chart.area -= 2 * middle;
      for (float& t : chart.thickness) t -= middle;
    }
    keep_largest();
  }

  void keep_largest() {
    std::vector<uint32_t> order(charts_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return charts_[a].share > charts_[b].share; });
    order.resize(std::min<size_t>(order.size(), kMaxCharts));
    std::vector<uint32_t> place(charts_.size(), kNone);
    for (uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
    for (const uint32_t c : order) {
      for (const size_t n : neighbours_[c]) {
        if (place[n] != kNone) charts_[c].neighbours.push_back(static_cast<uint8_t>(place[n]));
      }
      std::sort(charts_[c].neighbours.begin(), charts_[c].neighbours.end());
      result_.signature.charts.push_back(std::move(charts_[c]));
    }
  }

  segmentation::Pieces pieces_;
  std::vector<double> areas_;
  double area_ = 0;
  std::vector<PieceSpectrum> spectra_;
  Point centre_ = Point::Zero();
  Weighted thickness_, straightness_, curvature_, reach_;
  std::vector<ChartSignature> charts_;
  std::vector<std::vector<size_t>> neighbours_;
  Signed result_;
};

}  // namespace

Signed sign(std::span<const float> positions, std::span<const uint32_t> triangles) {
  return Signer(positions, triangles).run();
}

}  // namespace reeb::retrieval
