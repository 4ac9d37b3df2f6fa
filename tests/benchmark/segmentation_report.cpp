// Tables of how stable the segmentation is and how well its regions predict motion, as CSV on
// standard output.
//
// segmentation_report stability|motion SEQUENCE.obj...     (with SEQUENCE.pc2 beside each)
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>

#include "segmentation/motion.h"
#include "segmentation/nearest.h"
#include "tests/benchmark/comparison.h"
#include "tests/benchmark/mesh_sequence.h"
#include "tests/benchmark/motion_clustering.h"
#include "tests/benchmark/perturbation.h"

namespace reeb::benchmark {
namespace {

using segmentation::MotionInput;
using segmentation::Point;
using segmentation::Result;

constexpr uint32_t kPoseStep = 20;
constexpr int kTrials = 5;
// Distance at which an extremity is still the same, in units of sqrt(area).
constexpr double kSameExtremity = 0.15;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class StabilityTable {
 public:
  explicit StabilityTable(const MeshSequence& sequence)
      : sequence_(sequence),
        matcher_(sequence.frame(0), sequence.triangles),
        reference_(segment(sequence.frame(0))) {}

  void print() {
    row("reference", reference_, reference_.labels, &reference_.feature_points);
    poses();
    std::mt19937 random(1);
    const auto frame = sequence_.frame(0);
    const double edge = mean_edge_length(frame, sequence_.triangles), extent = diagonal(frame);
    for (int i = 0; i < kTrials; ++i) {
      changed("noise 0.5 % edge", add_noise(frame, 0.005 * edge, random));
      changed("noise 1 % diagonal", add_noise(frame, 0.01 * extent, random));
      changed("turned and scaled", turn_and_scale(frame, 0.013, random));
    }
    decimated();
  }

 private:
  Result segment(std::span<const float> positions) const {
    return segmentation::segment(positions, sequence_.triangles);
  }

  void poses() {
    std::vector<Result> all = {reference_};
    double least = 1;
    int same = 1;
    for (uint32_t t = kPoseStep; t < sequence_.frame_count; t += kPoseStep) {
      Result pose = segment(sequence_.frame(t));
      row("frame " + std::to_string(t + 1), pose, pose.labels, &pose.feature_points);
      for (const Result& other : all)
        least = std::min(least, rand_index(other.labels, pose.labels));
      same += is_same(pose.feature_points);
      all.push_back(std::move(pose));
    }
    std::printf("%s,all poses,%d of %zu with the same extremities,,,,,%.3f\n",
                sequence_.name.c_str(), same, all.size(), least);
  }

  void changed(const std::string& what, const std::vector<float>& positions) {
    const Result result = segment(positions);
    row(what, result, result.labels, &result.feature_points);
  }

  // Vertices of the full mesh take the label of the nearest vertex of the decimated one.
  void decimated() {
    const DecimatedMesh half = decimate_to_half(sequence_.frame(0), sequence_.triangles);
    const Result result = segmentation::segment(half.positions, half.triangles);
    const auto points_of = [](std::span<const float> positions) {
      std::vector<Point> points;
      for (size_t i = 0; i + 2 < positions.size(); i += 3) {
        points.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
      }
      return points;
    };
    const std::vector<Point> full = points_of(sequence_.frame(0)), left = points_of(half.positions);
    const segmentation::NearestPoint nearest_left(left), nearest_full(full);
    std::vector<uint32_t> labels, extremities;
    for (const Point& p : full) labels.push_back(result.labels[nearest_left.find(p)]);
    for (const uint32_t v : result.feature_points)
      extremities.push_back(nearest_full.find(left[v]));
    row("decimated to half", result, labels, &extremities);
  }

  bool is_same(const std::vector<uint32_t>& extremities) const {
    return matcher_.same(reference_.feature_points, extremities, kSameExtremity);
  }

  void row(const std::string& what, const Result& result, const std::vector<uint32_t>& labels,
           const std::vector<uint32_t>* extremities) const {
    std::printf("%s,%s,%zu,%s,%zu,%u,%u,%.3f\n", sequence_.name.c_str(), what.c_str(),
                result.feature_points.size(), is_same(*extremities) ? "same" : "other",
                result.graph.arcs.size(), result.graph.loops(), result.region_count,
                rand_index(reference_.labels, labels));
    std::fflush(stdout);
  }

  const MeshSequence& sequence_;
  ExtremityMatcher matcher_;
  Result reference_;
};

void print_motion_row(const MeshSequence& sequence, const char* kind, uint32_t count,
                      const MotionInput& input, const std::vector<uint32_t>& labels) {
  std::vector<uint32_t> adjusted;
  const double seconds = seconds_of([&] { adjusted = adjust_borders(input, labels); });
  double clustered = std::numeric_limits<double>::infinity();
  for (uint32_t seed = 1; seed <= 3; ++seed) {
    clustered = std::min(clustered, motion_error(input, cluster_motion(input, count, seed)));
  }
  const double error = motion_error(input, adjusted);
  std::printf("%s,%s,%u,%.4f,%.4f,%.4f,%.3f,%.2f\n", sequence.name.c_str(), kind, count,
              motion_error(input, labels), error, clustered, error / clustered, seconds);
  std::fflush(stdout);
}

void print_motion(const MeshSequence& sequence) {
  const MotionInput input = {sequence.frame(0), sequence.triangles, sequence.frames};
  const Result result = segmentation::segment(input.positions, input.triangles);
  print_motion_row(sequence, "graph", result.region_count, input, result.labels);
  const segmentation::MotionPartitions partitions(input, result);
  for (const uint32_t count : {result.region_count, 8u, 16u, 32u, 57u, 80u}) {
    if (count > partitions.finest()) continue;
    print_motion_row(sequence, "merged", count, input, partitions.labels(count));
  }
}

int run(int argc, char** argv) {
  const bool stability = argc > 2 && std::strcmp(argv[1], "stability") == 0;
  if (!stability && (argc < 3 || std::strcmp(argv[1], "motion") != 0)) {
    std::fprintf(stderr, "usage: segmentation_report stability|motion SEQUENCE.obj...\n");
    return 2;
  }
  std::printf(stability
                  ? "sequence,mesh,extremities,against frame 1,arcs,loops,regions,Rand index\n"
                  : "sequence,regions from,count,E %%,E adjusted %%,E clustering %%,ratio,"
                    "adjusting s\n");
  for (int i = 2; i < argc; ++i) {
    MeshSequence sequence;
    if (!read_sequence(argv[i], sequence)) {
      std::fprintf(stderr, "%s: skipped, it or its .pc2 cannot be read\n", argv[i]);
      continue;
    }
    if (stability) {
      StabilityTable(sequence).print();
    } else {
      print_motion(sequence);
    }
  }
  return 0;
}

}  // namespace
}  // namespace reeb::benchmark

int main(int argc, char** argv) { return reeb::benchmark::run(argc, argv); }
