#include "segmentation/motion.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "segmentation/affine_fit.h"
#include "segmentation/skeleton.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::segmentation;
using shapes::Mesh;

namespace {

constexpr int kFrames = 9;

// A tube along z that bends like a hinge: what lies above `hinge` turns about an axis there.
struct Hinge {
  Mesh mesh = shapes::open_cylinder(16, 40, 0.4, 8);
  std::vector<float> frames;
  std::vector<uint32_t> halves;

  explicit Hinge(double hinge) {
    for (int t = 0; t < kFrames; ++t) {
      const double angle = 0.15 * t;
      for (size_t i = 0; i < mesh.positions.size(); i += 3) {
        const double x = mesh.positions[i], y = mesh.positions[i + 1], z = mesh.positions[i + 2];
        const bool turns = z > hinge;
        const double s = turns ? std::sin(angle) : 0, c = turns ? std::cos(angle) : 1;
        for (const double p : {c * x + s * (z - hinge), y, c * (z - hinge) - s * x + hinge}) {
          frames.push_back(static_cast<float>(p + t));  // and all of it moves along
        }
        if (t == 0) halves.push_back(turns);
      }
    }
  }

  MotionInput input() const { return {mesh.positions, mesh.triangles, frames}; }
};

size_t regions_of(const std::vector<uint32_t>& labels) {
  return std::set<uint32_t>(labels.begin(), labels.end()).size();
}

}  // namespace

TEST_CASE("rigid halves are predicted without error, the whole is not") {
  const Hinge hinge(3.9);
  CHECK(motion_error(hinge.input(), hinge.halves) < 1e-4);
  CHECK(motion_error(hinge.input(), std::vector<uint32_t>(hinge.halves.size(), 0)) > 3);
}

TEST_CASE("the error is that of its definition") {
  // Four corners of a square; in the only frame one corner is lifted by 1. The best affine fit
  // leaves the part in the pattern + - + -: each corner is off by 1/4. The mean is (1/2, 1/2, 1/4).
  const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::vector<float> lifted = square;
  lifted[2] = 1;
  const std::vector<uint32_t> triangles = {0, 1, 2, 0, 2, 3};
  const double signal = 8 * 0.25 + 0.5625 + 3 * 0.0625;
  CHECK(motion_error({square, triangles, lifted}, std::vector<uint32_t>(4, 0)) ==
        Approx(100 * std::sqrt(4 * 0.0625 / signal)).epsilon(1e-6));
  CHECK(motion_error({square, triangles, {}}, std::vector<uint32_t>(4, 0)) == 0);
  CHECK(motion_error({{}, {}, {}}, {}) == 0);
}

TEST_CASE("a fit of few or collinear points is finite and exact") {
  const Hinge hinge(3.9);
  const MotionSpace space = motion_space(hinge.input(), 64);
  for (const std::vector<uint32_t>& members : {std::vector<uint32_t>{3}, {0, 16, 32, 48}, {}}) {
    AffineSums sums(space.rows.rows());
    for (const uint32_t v : members) sums.add(space, v);
    REQUIRE(residual(sums) >= 0);
    const AffineMap map = affine_fit(sums);
    for (const uint32_t v : members) {
      CHECK(squared_error(space, v, map) < 1e-9 * (1 + space.rows.col(v).squaredNorm()));
    }
  }
}

TEST_CASE("a reduced motion space keeps residuals") {
  const Hinge hinge(3.9);
  const MotionSpace space = motion_space(hinge.input(), 64);
  std::vector<uint32_t> labels = hinge.halves;
  for (uint32_t v = 0; v < 64; ++v) labels[v] = 1;  // some error
  double sum = 0;
  for (const AffineSums& sums : region_sums(space, labels, 2)) sum += residual(sums);
  double signal = 0;
  const size_t size = hinge.mesh.positions.size();
  for (int t = 0; t < kFrames; ++t) {
    const Eigen::Map<const Eigen::Matrix3Xf> frame(hinge.frames.data() + t * size, 3, size / 3);
    const Eigen::Matrix3Xd x = frame.cast<double>();
    signal += (x.colwise() - x.rowwise().mean().eval()).squaredNorm();
  }
  CHECK(100 * std::sqrt(sum / signal) == Approx(motion_error(hinge.input(), labels)).epsilon(1e-3));
}

TEST_CASE("the partition into two regions finds the hinge") {
  const Hinge hinge(3.9);
  const Result result = segment(hinge.mesh.positions, hinge.mesh.triangles);
  const MotionPartitions partitions(hinge.input(), result);
  REQUIRE(partitions.finest() > 10);
  const std::vector<uint32_t> adjusted = adjust_borders(hinge.input(), partitions.labels(2));
  CHECK(regions_of(adjusted) == 2);
  CHECK(motion_error(hinge.input(), adjusted) < 1e-3);
}

TEST_CASE("partitions are nested, complete and ever cheaper") {
  const Hinge hinge(5.1);
  const Result result = segment(hinge.mesh.positions, hinge.mesh.triangles);
  const MotionPartitions partitions(hinge.input(), result, 16);
  std::vector<uint32_t> finer = partitions.labels(partitions.finest());
  for (uint32_t count = partitions.finest(); count >= 1; --count) {
    const std::vector<uint32_t> labels = partitions.labels(count);
    REQUIRE(regions_of(labels) == count);
    std::map<uint32_t, uint32_t> coarse_of;
    for (size_t v = 0; v < labels.size(); ++v) {
      REQUIRE(coarse_of.try_emplace(finer[v], labels[v]).first->second == labels[v]);
    }
    if (count > 1) {
      CHECK(partitions.squared_error(count) <= partitions.squared_error(count - 1) * (1 + 1e-9));
    }
    finer = labels;
  }
}

TEST_CASE("pieces that move together merge across the gap") {
  // Two tubes side by side, each bending at its own height, and a third that moves like the first.
  const Hinge low(2.1), high(6.1);
  Mesh mesh;
  std::vector<float> frames;
  const std::vector<const Hinge*> tubes = {&low, &high, &low};
  const size_t size = low.mesh.positions.size();
  for (size_t i = 0; i < tubes.size(); ++i) {
    Mesh tube = tubes[i]->mesh;
    for (size_t k = 1; k < size; k += 3) tube.positions[k] += 2 * static_cast<float>(i);
    mesh.append(tube);
  }
  for (int t = 0; t < kFrames; ++t) {
    for (size_t i = 0; i < tubes.size(); ++i) {
      for (size_t k = 0; k < size; ++k) {
        frames.push_back(tubes[i]->frames[t * size + k] +
                         (k % 3 == 1 ? 2 * static_cast<float>(i) : 0));
      }
    }
  }
  const MotionInput input = {mesh.positions, mesh.triangles, frames};
  const Result result = segment(mesh.positions, mesh.triangles);
  const MotionPartitions partitions(input, result);
  CHECK(motion_error(input, adjust_borders(input, partitions.labels(6))) < 1e-3);
  CHECK(regions_of(partitions.labels(1)) == 1);
}

TEST_CASE("borders move to where the motion changes, and regions stay connected") {
  const Hinge hinge(3.9);
  std::vector<uint32_t> labels;
  for (size_t v = 0; v < hinge.halves.size(); ++v) {
    labels.push_back(hinge.mesh.positions[3 * v + 2] > 5.5F);
  }
  const double before = motion_error(hinge.input(), labels);
  const std::vector<uint32_t> adjusted = adjust_borders(hinge.input(), labels);
  CHECK(before > 1);
  CHECK(adjusted == hinge.halves);
}

TEST_CASE("no region vanishes") {
  const Hinge hinge(3.9);
  std::vector<uint32_t> labels = hinge.halves;
  labels[0] = 2;  // one vertex of its own, which its neighbours predict as well
  CHECK(regions_of(adjust_borders(hinge.input(), labels)) == 3);
}

TEST_CASE("motion functions take empty and still input") {
  const Hinge hinge(3.9);
  const MotionInput still = {hinge.mesh.positions, hinge.mesh.triangles, hinge.mesh.positions};
  const Result result = segment(hinge.mesh.positions, hinge.mesh.triangles);
  CHECK(adjust_borders(still, hinge.halves) == hinge.halves);
  CHECK(regions_of(MotionPartitions(still, result).labels(3)) == 3);
  CHECK(MotionPartitions({{}, {}, {}}, segment({}, {})).finest() == 0);
  CHECK(adjust_borders({{}, {}, {}}, {}).empty());
  // A cloud of points without triangles is one patch.
  const MotionInput cloud = {hinge.mesh.positions, {}, hinge.frames};
  CHECK(MotionPartitions(cloud, segment(hinge.mesh.positions, {})).finest() == 1);
}

TEST_CASE("thousands of pieces start from the regions of the segmentation") {
  Mesh mesh;
  for (uint32_t i = 0; i < 5000; ++i) {
    const float x = static_cast<float>(i % 100), y = static_cast<float>(i / 100);
    mesh.positions.insert(mesh.positions.end(), {x, y, 0, x + 0.5F, y, 0, x, y + 0.5F, 0});
    mesh.triangles.insert(mesh.triangles.end(), {3 * i, 3 * i + 1, 3 * i + 2});
  }
  const MotionInput input = {mesh.positions, mesh.triangles, mesh.positions};
  Options options;
  options.max_regions = 50;
  const Result result = segment(mesh.positions, mesh.triangles, options);
  const MotionPartitions partitions(input, result);
  CHECK(partitions.finest() == 50);
  CHECK(regions_of(partitions.labels(7)) == 7);
}

TEST_CASE("the skeleton of a tube runs along its axis and follows the motion") {
  const Hinge hinge(100);  // moves as a whole
  const Result result = segment(hinge.mesh.positions, hinge.mesh.triangles);
  REQUIRE(result.graph.arcs.size() == 1);
  const Skeleton skeleton(result, hinge.mesh.positions, hinge.mesh.triangles);
  const SkeletonPose rest = skeleton.place(hinge.mesh.positions);
  REQUIRE(rest.nodes.size() == 2);
  REQUIRE(rest.arcs.size() == 1);
  REQUIRE(rest.arcs[0].size() > 3);
  const float direction = rest.nodes[1][2] - rest.nodes[0][2] > 0 ? 1.F : -1.F;
  for (size_t i = 0; i < rest.arcs[0].size(); ++i) {
    const Position& p = rest.arcs[0][i];
    CHECK(std::hypot(p[0], p[1]) < 0.3F);
    if (i > 0) CHECK(direction * (p[2] - rest.arcs[0][i - 1][2]) > 0);
  }
  CHECK(rest.regions[0][2] == Approx(4).margin(0.01));
  const size_t size = hinge.mesh.positions.size();
  const SkeletonPose last =
      skeleton.place(std::span(hinge.frames).subspan((kFrames - 1) * size, size));
  for (size_t i = 0; i < 3; ++i) {
    CHECK(last.nodes[1][i] == Approx(rest.nodes[1][i] + kFrames - 1).margin(1e-4));
    CHECK(last.arcs[0][2][i] == Approx(rest.arcs[0][2][i] + kFrames - 1).margin(1e-4));
  }
}
