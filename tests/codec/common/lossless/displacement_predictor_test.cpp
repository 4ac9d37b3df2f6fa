#include "codec/common/lossless/displacement_predictor.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/codec/shapes.h"

using namespace reeb;
using namespace reeb::test;

namespace {

/// Frames of a bending torus in the order of its surface graph, the first one at rest.
struct Scene {
  SurfaceGraph surface;
  std::vector<std::vector<float>> frames;  ///< [row][xyz]

  explicit Scene(uint32_t count) {
    const Shape shape = torus(14, 9);
    const std::vector<int32_t> grid = on_grid(shape, 10);
    surface = build_surface_graph(GridPoints(grid), triangles_of(shape.connectivity));
    const Shot shot = animate(shape, count);
    for (uint32_t t = 0; t < count; ++t) {
      std::vector<float>& frame = frames.emplace_back();
      for (const uint32_t v : surface.order)
        for (uint32_t a = 0; a < 3; ++a) frame.push_back(shot.frame(t)[v * 3 + a]);
    }
  }
  Eigen::Vector3d at(uint32_t t, uint32_t row) const {
    const float* x = &frames[t][row * size_t{3}];
    return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
  }
  Eigen::Vector3d moved(uint32_t t, uint32_t row) const { return at(t, row) - at(t - 1, row); }
};

/// Predictions of one row by plain least squares, as spec/lossless.md gives them.
class PlainRow {
 public:
  PlainRow(const Scene& scene, uint32_t row, uint32_t neighbours) : scene_(scene), row_(row) {
    const PredictionGraph::Row& r = scene.surface.graph.rows[row];
    const uint32_t used = std::min<uint32_t>(r.count, neighbours);
    near_.assign(r.neighbour.begin(), r.neighbour.begin() + used);
    prior_ = Eigen::VectorXd::Zero(2 + used);
    for (uint32_t i = 0; i < used; ++i) prior_[2 + i] = static_cast<double>(r.prior[i]);
    matrix_ = Eigen::MatrixXd::Zero(prior_.size(), prior_.size());
    target_ = Eigen::VectorXd::Zero(prior_.size());
    weights_ = prior_;
  }

  Eigen::Vector3d predict(uint32_t t) const {
    return scene_.at(t - 1, row_) + terms(t).transpose() * weights_;
  }

  /// After predict(t) of the frames before.
  void learn(uint32_t t) {
    const Eigen::Vector3d error = scene_.at(t, row_) - predict(t);
    const Eigen::MatrixXd y = terms(t);
    matrix_ = matrix_ * (507.0 / 512) + y * y.transpose();
    target_ = target_ * (507.0 / 512) + y * scene_.moved(t, row_);
    energy_ = energy_ / 4 + error.squaredNorm() * 0.75;
    const double ridge = std::max(energy_ / 8, matrix_.trace() * std::pow(2.0, -34)) + 1e-100;
    Eigen::MatrixXd a = matrix_;
    a.diagonal().array() += ridge;
    weights_ = a.ldlt().solve(target_ + ridge * prior_);
  }

 private:
  /// Terms in rows, axes in columns.
  Eigen::MatrixXd terms(uint32_t t) const {
    Eigen::MatrixXd y(prior_.size(), 3);
    for (Eigen::Index back = 1; back <= 2; ++back) {
      const bool known = t > static_cast<uint32_t>(back);
      const Eigen::Vector3d own =
          known ? scene_.moved(t - static_cast<uint32_t>(back), row_) : Eigen::Vector3d::Zero();
      y.row(back - 1) = own.transpose();
    }
    for (size_t i = 0; i < near_.size(); ++i)
      y.row(static_cast<Eigen::Index>(2 + i)) = scene_.moved(t, near_[i]).transpose();
    return y;
  }

  const Scene& scene_;
  uint32_t row_;
  std::vector<uint32_t> near_;
  Eigen::VectorXd prior_, target_, weights_;
  Eigen::MatrixXd matrix_;
  double energy_ = 0;
};

}  // namespace

TEST_CASE("weights follow the motion by least squares", "[displacement_predictor]") {
  const uint32_t neighbours = GENERATE(14u, 6u);
  const Scene scene(24);
  const SurfaceGraph& surface = scene.surface;
  // The frame before the first one is the first one itself: nothing moves, nothing is learned.
  DisplacementPredictor predictor(surface.graph, scene.frames[0], {.neighbours = neighbours}, 2);
  std::vector<PlainRow> plain;
  for (const uint32_t row : {70u, 125u}) plain.emplace_back(scene, row, neighbours);
  for (uint32_t t = 0; t < 24; ++t) {
    for (uint32_t row = 0; row < surface.graph.size(); ++row) {
      const std::array<double, 3> p = predictor.predict(row);
      if (t > 0 && (row == 70 || row == 125)) {
        const Eigen::Vector3d expected = plain[row == 70 ? 0 : 1].predict(t);
        for (int a = 0; a < 3; ++a)
          CHECK(p[static_cast<size_t>(a)] == Approx(expected[a]).margin(1e-5));
      }
      predictor.place(row, &scene.frames[t][row * size_t{3}], p);
    }
    predictor.finish_frame();
    if (t == 0) continue;
    for (PlainRow& row : plain) row.learn(t);
  }
}

TEST_CASE("a jump starts from rest", "[displacement_predictor]") {
  const Scene scene(6);
  DisplacementPredictor predictor(scene.surface.graph, scene.frames[0], {}, 1);
  for (const auto& frame : scene.frames) {
    for (uint32_t row = 0; row < scene.surface.graph.size(); ++row)
      predictor.place(row, &frame[row * size_t{3}], predictor.predict(row));
    predictor.finish_frame();
  }
  predictor.jump(scene.frames[2]);
  for (uint32_t row = 0; row < scene.surface.graph.size(); ++row) {
    const std::array<double, 3> p = predictor.predict(row);
    const float* x = &scene.frames[2][row * size_t{3}];
    for (size_t a = 0; a < 3; ++a) CHECK(p[a] == static_cast<double>(x[a]));
    predictor.place(row, x, p);
  }
}

TEST_CASE("a quick predictor learns from its first frames and then from every fourth",
          "[displacement_predictor]") {
  const Scene scene(12);
  DisplacementPredictor sparse(scene.surface.graph, scene.frames[0], {.period = 4}, 1);
  DisplacementPredictor dense(scene.surface.graph, scene.frames[0], {}, 1);
  uint32_t apart = 12;
  for (uint32_t t = 0; t < 12; ++t) {
    for (uint32_t row = 0; row < scene.surface.graph.size(); ++row) {
      const auto p = sparse.predict(row);
      const auto q = dense.predict(row);
      if (p != q) apart = std::min(apart, t);
      sparse.place(row, &scene.frames[t][row * size_t{3}], p);
      dense.place(row, &scene.frames[t][row * size_t{3}], q);
    }
    sparse.finish_frame();
    dense.finish_frame();
  }
  CHECK(apart == 10);  // frames 1 .. 8 are learned from by both, frame 9 by one
}
