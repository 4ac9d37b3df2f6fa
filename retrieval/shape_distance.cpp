#include "retrieval/shape_distance.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "retrieval/assignment.h"

namespace reeb::retrieval {
namespace {

// Weights of what charts differ in. All but the kind are differences of logarithms.
constexpr double kArea = 0.5, kGirth = 0.5, kHeight = 0.2, kKind = 0.5;
constexpr double kAreaStretch = 0.2, kAngleStretch = 0.5, kThickness = 0.5;
// Part of the likeness of two charts that rests on their neighbours' being matched as well.
constexpr double kAdjacency = 0.1;

// Medians of the parts of a distance over generated figures and scanned, animated bodies: in units
// of them users see the parts.
constexpr double kTypicalCharts = 0.73, kTypicalHeat = 0.17, kTypicalWave = 0.22;
constexpr double kTypicalThickness = 0.23, kTypicalStraightness = 0.066;
constexpr double kTypicalCurvature = 0.83, kTypicalReach = 0.18;

constexpr double kRounding = 0.01;  // in such units: what the bytes of a signature round off

using Values = std::vector<float>;

double mean_difference(const Values& a, const Values& b) {
  const size_t n = std::min(a.size(), b.size());
  double sum = 0;
  for (size_t i = 0; i < n; ++i) sum += std::abs(a[i] - b[i]);
  return n > 0 ? sum / static_cast<double>(n) : 0;
}

double mean_difference_reversed(const Values& a, const Values& b) {
  return mean_difference({a.rbegin(), a.rend()}, b);
}

// Of two quantile functions that a shift lays on each other: of logarithms, whatever the unit.
double shape_difference(const Values& a, const Values& b) {
  std::vector<double> differences;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) differences.push_back(a[i] - b[i]);
  if (differences.empty()) return 0;
  std::vector<double> sorted = differences;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const double shift = sorted[sorted.size() / 2];
  double sum = 0;
  for (const double d : differences) sum += std::abs(d - shift);
  return sum / static_cast<double>(differences.size());
}

double profile_difference(const ChartSignature& a, const ChartSignature& b) {
  const auto weighted = [&](auto difference) {
    return kAreaStretch * difference(a.area_stretch, b.area_stretch) +
           kAngleStretch * difference(a.angle_stretch, b.angle_stretch) +
           kThickness * difference(a.thickness, b.thickness);
  };
  const double straight = weighted(mean_difference);
  // Which end of a tube is the first may be an accident.
  return a.annulus && b.annulus ? std::min(straight, weighted(mean_difference_reversed)) : straight;
}

double size_of(const ChartSignature& chart) { return std::sqrt(chart.share); }

double size_of(const Signature& s) {
  double sum = 0;
  for (const ChartSignature& chart : s.charts) sum += size_of(chart);
  return sum;
}

Eigen::MatrixXd likeness(const Signature& a, const Signature& b) {
  Eigen::MatrixXd gain(a.charts.size(), b.charts.size());
  for (size_t i = 0; i < a.charts.size(); ++i) {
    for (size_t j = 0; j < b.charts.size(); ++j) {
      const double size = 0.5 * (size_of(a.charts[i]) + size_of(b.charts[j]));
      gain(i, j) = size * (1 - chart_distance(a.charts[i], b.charts[j]));
    }
  }
  return gain;
}

// Part of the neighbours of chart i of `a` whose matches are neighbours of chart j of `b`.
double kept_neighbours(const Signature& a, const Signature& b, const std::vector<uint32_t>& match,
                       size_t i, size_t j) {
  const auto& of_a = a.charts[i].neighbours;
  const auto& of_b = b.charts[j].neighbours;
  if (of_a.empty() && of_b.empty()) return 1;
  size_t kept = 0;
  for (const uint8_t n : of_a)
    kept += match[n] != kUnmatched && std::binary_search(of_b.begin(), of_b.end(), match[n]);
  return static_cast<double>(kept) / static_cast<double>(std::max(of_a.size(), of_b.size()));
}

double geometric_mean(std::initializer_list<double> parts) {
  double product = 1;
  for (const double part : parts) product *= part + kRounding;
  return std::max(0.0, std::pow(product, 1.0 / static_cast<double>(parts.size())) - kRounding);
}

}  // namespace

double chart_distance(const ChartSignature& a, const ChartSignature& b) {
  double d = kArea * std::abs(a.area - b.area) + kGirth * std::abs(a.girth - b.girth) +
             profile_difference(a, b);
  if (a.annulus != b.annulus) d += kKind;
  if (a.annulus && b.annulus) d += kHeight * std::abs(a.height - b.height);
  return d / (1 + d);
}

ChartMatch match_charts(const Signature& a, const Signature& b) {
  const double whole = 0.5 * (size_of(a) + size_of(b));
  if (!(whole > 0)) return {};
  ChartMatch result{std::vector<uint32_t>(a.charts.size(), kUnmatched), 1};
  if (a.charts.empty() || b.charts.empty()) return result;
  const Eigen::MatrixXd gain = likeness(a, b);
  const std::vector<uint32_t> first = best_assignment(-gain);
  Eigen::MatrixXd with_neighbours = gain;
  for (size_t i = 0; i < a.charts.size(); ++i) {
    for (size_t j = 0; j < b.charts.size(); ++j)
      with_neighbours(i, j) *= 1 - kAdjacency * (1 - kept_neighbours(a, b, first, i, j));
  }
  result.match = best_assignment(-with_neighbours);
  double alike = 0;
  for (size_t i = 0; i < result.match.size(); ++i) {
    if (result.match[i] != kUnmatched) alike += gain(i, result.match[i]);
  }
  result.distance = std::max(0.0, 1 - alike / whole);
  return result;
}

ShapeDistance shape_distance(const Signature& a, const Signature& b) {
  const double charts = match_charts(a, b).distance / kTypicalCharts;
  const double heat = mean_difference(a.heat, b.heat) / kTypicalHeat;
  const double wave = mean_difference(a.wave, b.wave) / kTypicalWave;
  const double thickness = shape_difference(a.thickness, b.thickness) / kTypicalThickness;
  const double straightness =
      mean_difference(a.straightness, b.straightness) / kTypicalStraightness;
  const double curvature = mean_difference(a.curvature, b.curvature) / kTypicalCurvature;
  const double reach = mean_difference(a.reach, b.reach) / kTypicalReach;
  return {.charts = charts,
          .spectrum = 0.5 * (heat + wave),
          .body = 0.25 * (thickness + straightness + curvature + reach),
          .total = geometric_mean({charts, heat, wave, thickness, straightness, curvature, reach})};
}

}  // namespace reeb::retrieval
