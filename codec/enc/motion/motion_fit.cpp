#include "codec/enc/motion/motion_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/enc/fields/row_links.h"

namespace reeb {

namespace {

constexpr uint32_t kAlternations = 3;
constexpr double kRidge =
    1e-6;  ///< relative to the mean diagonal, for regions that are flat or small
constexpr double kWorthwhile =
    0.9;  ///< a second region must leave less than this part of the error

}  // namespace

MotionFit::MotionFit(const SurfaceContext& surface, Eigen::MatrixXf coefficients,
                     std::span<const uint32_t> labels, uint32_t regions)
    : surface_(surface), coefficients_(std::move(coefficients)), model_(regions, 0) {
  model_.bindings().resize(surface.rows());
  for (uint32_t row = 0; row < surface.rows(); ++row)
    model_.bindings()[row].primary = labels[surface.input[row]];
  model_.locate(surface.surface.points(), surface.surface.order);
  if (coefficients_.cols() == 0) return;  // nothing moves
  fit_transforms();
  for (uint32_t i = 0; i < kAlternations; ++i) {
    fit_weights();
    fit_transforms();
  }
}

MotionFit::Design MotionFit::design(uint32_t row) const {
  const RegionBinding& b = model_.bindings()[row];
  const double share = static_cast<double>(b.weight) / RegionBinding::kWeightUnit;
  const auto first = model_.coordinates(row, b.primary);
  const auto second = model_.coordinates(row, b.secondary);
  Design out{};
  for (uint32_t i = 0; i < MotionModel::kParameters; ++i) {
    out[i] = (1 - share) * static_cast<double>(first[i]);
    out[MotionModel::kParameters + i] = share * static_cast<double>(second[i]);
  }
  return out;
}

void MotionFit::fit_transforms() {
  constexpr uint32_t kP = MotionModel::kParameters;
  const auto unknowns = Eigen::Index{model_.regions()} * kP;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, coefficients_.cols());
  for (uint32_t row = 0; row < surface_.rows(); ++row) {
    const RegionBinding& b = model_.bindings()[row];
    const Design d = design(row);
    const Eigen::RowVectorXd t = coefficients_.row(row).cast<double>();
    const auto column = [&](uint32_t i) {
      return Eigen::Index{(i < kP ? b.primary : b.secondary)} * kP + i % kP;
    };
    const uint32_t used = b.weight > 0 ? 2 * kP : kP;
    for (uint32_t i = 0; i < used; ++i) {
      right.row(column(i)) += d[i] * t;
      for (uint32_t j = 0; j < used; ++j) normal(column(i), column(j)) += d[i] * d[j];
    }
  }
  const double ridge = kRidge * normal.trace() / static_cast<double>(unknowns) + 1e-12;
  normal.diagonal().array() += ridge;
  transforms_ = normal.llt().solve(right);
}

Eigen::VectorXd MotionFit::moved(uint32_t row, uint32_t region) const {
  const auto u = model_.coordinates(row, region);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(transforms_.cols());
  for (uint32_t i = 0; i < MotionModel::kParameters; ++i) {
    out += static_cast<double>(u[i]) *
           transforms_.row(Eigen::Index{region} * MotionModel::kParameters + i).transpose();
  }
  return out;
}

Eigen::VectorXd MotionFit::target(uint32_t row) const {
  return coefficients_.row(row).cast<double>().transpose();
}

void MotionFit::fit_weights() {
  const RowLinks links = link_rings(surface_.surface.graph);
  const std::vector<RegionBinding> before = model_.bindings();
  for (uint32_t row = 0; row < surface_.rows(); ++row) {
    RegionBinding& binding = model_.bindings()[row];
    binding.secondary = binding.weight = 0;
    Eigen::VectorXd
        residual;  // of the primary region alone; computed where there is a neighbour region
    double best = 0;
    for (const uint32_t linked : links[row]) {
      const RegionBinding& other = before[linked];
      for (const uint32_t region : {other.primary, other.secondary}) {
        if (region == binding.primary || (region == other.secondary && other.weight == 0)) continue;
        if (residual.size() == 0) {
          residual = target(row) - moved(row, binding.primary);
          best = kWorthwhile * residual.squaredNorm();
        }
        const Eigen::VectorXd change = moved(row, region) - (target(row) - residual);
        const double share = residual.dot(change) / std::max(change.squaredNorm(), 1e-300);
        const double steps = std::round(share * RegionBinding::kWeightUnit);
        const auto weight =
            static_cast<uint32_t>(std::clamp(steps, 0.0, double{RegionBinding::kMaxWeight}));
        const double left =
            (residual - (weight / double{RegionBinding::kWeightUnit}) * change).squaredNorm();
        if (weight == 0 || left >= best) continue;
        best = left;
        binding.secondary = region;
        binding.weight = weight;
      }
    }
  }
}

MotionModel MotionFit::quantize(const float (&step)[3], uint32_t components) const {
  MotionModel out = model_;
  out.set_components(components);
  for (uint32_t k = 0; k < components; ++k) {
    std::vector<MotionModel::Transform>& t = out.transforms(k);
    t.assign(model_.regions(), MotionModel::Transform{});
    if (k >= transforms_.cols()) continue;
    const double scale = 1 / static_cast<double>(step[k % 3] * MotionModel::kTransformStep);
    for (uint32_t b = 0; b < model_.regions(); ++b) {
      for (uint32_t i = 0; i < MotionModel::kParameters; ++i) {
        const double z = transforms_(Eigen::Index{b} * MotionModel::kParameters + i, k) * scale;
        t[b][i] = static_cast<int32_t>(std::clamp(std::round(z), -1e9, 1e9));
      }
    }
  }
  return out;
}

}  // namespace reeb
