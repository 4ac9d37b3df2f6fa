#include <algorithm>

#include "tools/io/attribute_values.h"
#include "tools/sample/isosurface.h"
#include "tools/sample/sample.h"
#include "tools/sample/unwrap.h"

namespace reeb::tools {
namespace {

/// A part of the skeleton with flesh around it: a cone between two balls.
struct Bone {
  int parent;  ///< -1 for the root; parents come first
  Vec3 head;   ///< the joint it turns about
  Vec3 tail;
  double head_radius;
  double tail_radius;
};

/// Indices into the skeleton. A leg has three bones, upper, lower and foot, from these on.
enum BoneIndex {
  kPelvis,
  kChest,
  kNeck,
  kHead,
  kLeftEar,
  kRightEar,
  kTailRoot,
  kTailMiddle,
  kTailTip,
  kFrontLeft,
  kFrontRight = kFrontLeft + 3,
  kHindLeft = kFrontRight + 3,
  kHindRight = kHindLeft + 3,
  kBoneCount = kHindRight + 3,
};

constexpr double kCell = 0.03;           ///< of the grid that finds the surface, metres
constexpr double kBlend = 0.07;          ///< width over which parts flow into each other, metres
constexpr int kWeightSmoothings = 24;    ///< rounds over the rings that soften the joints
constexpr double kFramesPerStride = 25;  ///< one cycle of the walk
constexpr double kStride = 0.62;         ///< way of one cycle, metres

void add_leg(std::vector<Bone>& bones, int parent, const Vec3& hip, const Vec3& knee,
             const Vec3& ankle, double thickness) {
  const int upper = static_cast<int>(bones.size());
  bones.push_back({parent, hip, knee, 1.35 * thickness, 0.8 * thickness});
  bones.push_back({upper, knee, ankle, 0.8 * thickness, 0.55 * thickness});
  bones.push_back(
      {upper + 1, ankle, ankle + Vec3{0.12, -0.03, 0}, 0.6 * thickness, 0.55 * thickness});
}

std::vector<Bone> make_skeleton() {
  std::vector<Bone> bones{
      {-1, {-0.05, 0.84, 0}, {-0.48, 0.80, 0}, 0.20, 0.21},
      {kPelvis, {-0.05, 0.84, 0}, {0.42, 0.84, 0}, 0.20, 0.24},
      {kChest, {0.48, 0.94, 0}, {0.76, 1.24, 0}, 0.17, 0.11},
      {kNeck, {0.78, 1.28, 0}, {1.09, 1.19, 0}, 0.14, 0.08},
      {kHead, {0.74, 1.36, 0.08}, {0.68, 1.50, 0.14}, 0.055, 0.03},
      {kHead, {0.74, 1.36, -0.08}, {0.68, 1.50, -0.14}, 0.055, 0.03},
      {kPelvis, {-0.60, 0.88, 0}, {-0.86, 0.98, 0}, 0.085, 0.065},
      {kTailRoot, {-0.86, 0.98, 0}, {-1.12, 0.92, 0}, 0.065, 0.052},
      {kTailMiddle, {-1.12, 0.92, 0}, {-1.38, 1.02, 0}, 0.052, 0.04},
  };
  for (const double side : {1.0, -1.0}) {
    add_leg(bones, kChest, {0.40, 0.70, 0.17 * side}, {0.36, 0.38, 0.19 * side},
            {0.39, 0.07, 0.19 * side}, 0.09);
  }
  for (const double side : {1.0, -1.0}) {
    add_leg(bones, kPelvis, {-0.46, 0.70, 0.17 * side}, {-0.38, 0.40, 0.20 * side},
            {-0.50, 0.07, 0.20 * side}, 0.10);
  }
  return bones;
}

double distance_to(const Bone& bone, const Vec3& p) {
  const Vec3 axis = bone.tail - bone.head;
  const double t = std::clamp(dot(p - bone.head, axis) / dot(axis, axis), 0.0, 1.0);
  const double radius = bone.head_radius + t * (bone.tail_radius - bone.head_radius);
  return length(p - (bone.head + axis * t)) - radius;
}

// A minimum whose crease is rounded off over `kBlend`.
double smooth_min(double a, double b) {
  const double h = std::max(kBlend - std::abs(a - b), 0.0) / kBlend;
  return std::min(a, b) - h * h * kBlend * 0.25;
}

double body_field(const std::vector<Bone>& bones, const Vec3& p) {
  double d = 1e9;
  for (const Bone& bone : bones) d = smooth_min(d, distance_to(bone, p));
  return d;
}

using Weights = std::array<double, kBoneCount>;

// The nearest bone, softened along the surface: limbs that only pass close by do not pull.
std::vector<Weights> skin_weights(const TriangleMesh& mesh, const std::vector<Bone>& bones) {
  std::vector<Weights> weights(mesh.vertices.size());
  for (size_t v = 0; v < weights.size(); ++v) {
    size_t nearest = 0;
    for (size_t b = 1; b < bones.size(); ++b) {
      const Vec3& p = mesh.vertices[v];
      if (distance_to(bones[b], p) < distance_to(bones[nearest], p)) nearest = b;
    }
    weights[v][nearest] = 1;
  }
  const auto rings = vertex_rings(mesh);
  for (int round = 0; round < kWeightSmoothings; ++round) {
    const std::vector<Weights> before = weights;
    for (size_t v = 0; v < weights.size(); ++v) {
      const double share = 0.5 / static_cast<double>(rings[v].size());
      for (size_t b = 0; b < kBoneCount; ++b) {
        double sum = 0;
        for (const uint32_t n : rings[v]) sum += before[n][b];
        weights[v][b] = 0.5 * before[v][b] + share * sum;
      }
    }
  }
  return weights;
}

// A leg `phase` turns into its cycle: it swings about the hip and bends while it goes forward.
void pose_leg(std::array<Pose, kBoneCount>& local, const std::vector<Bone>& bones, int upper,
              double phase, double bend) {
  const auto u = static_cast<size_t>(upper);
  const double swing = 0.075 * turn_sine(phase);
  const double lift = std::max(0.0, turn_cosine(phase));
  local[u] = rotation(2, swing + 0.03 * bend * lift, bones[u].head);
  local[u + 1] = rotation(2, -0.14 * bend * lift * lift, bones[u + 1].head);
  local[u + 2] = rotation(2, -0.6 * swing + 0.05 * bend * lift, bones[u + 2].head);
}

// Pose of every bone in space, `cycle` strides after the start.
std::array<Pose, kBoneCount> pose_at(const std::vector<Bone>& bones, double cycle) {
  std::array<Pose, kBoneCount> local;
  local[kPelvis] = rotation(1, 0.008 * turn_sine(cycle), bones[kPelvis].head) *
                   rotation(0, 0.008 * turn_cosine(cycle), bones[kPelvis].head);
  local[kPelvis].shift += Vec3{kStride * cycle, 0.014 * turn_sine(2 * cycle), 0};
  local[kChest] = rotation(1, -0.02 * turn_sine(cycle + 0.1), bones[kChest].head) *
                  rotation(2, 0.006 * turn_sine(2 * cycle), bones[kChest].head);
  local[kNeck] = rotation(2, 0.022 * turn_sine(2 * cycle + 0.2), bones[kNeck].head) *
                 rotation(1, 0.03 * turn_sine(0.4 * cycle), bones[kNeck].head);
  local[kHead] = rotation(2, -0.018 * turn_sine(2 * cycle + 0.1), bones[kHead].head) *
                 rotation(1, 0.04 * turn_sine(0.4 * cycle + 0.1), bones[kHead].head);
  local[kLeftEar] = rotation(0, 0.03 * turn_sine(2 * cycle), bones[kLeftEar].head);
  local[kRightEar] = rotation(0, -0.03 * turn_sine(2 * cycle + 0.15), bones[kRightEar].head);
  for (const int b : {kTailRoot, kTailMiddle, kTailTip}) {
    const double lag = 0.16 * (b - kTailRoot);
    const Vec3& joint = bones[static_cast<size_t>(b)].head;
    local[static_cast<size_t>(b)] = rotation(1, 0.05 * turn_sine(cycle - lag), joint) *
                                    rotation(2, 0.015 * turn_sine(2 * cycle - lag), joint);
  }
  pose_leg(local, bones, kFrontLeft, cycle, 1);
  pose_leg(local, bones, kFrontRight, cycle + 0.5, 1);
  pose_leg(local, bones, kHindLeft, cycle + 0.75, 0.9);
  pose_leg(local, bones, kHindRight, cycle + 0.25, 0.9);

  std::array<Pose, kBoneCount> pose;
  for (size_t b = 0; b < kBoneCount; ++b) {
    const int parent = bones[b].parent;
    pose[b] = parent < 0 ? local[b] : pose[static_cast<size_t>(parent)] * local[b];
  }
  return pose;
}

void append_skinned(const TriangleMesh& mesh, const std::vector<Weights>& weights,
                    const std::array<Pose, kBoneCount>& pose, std::vector<float>& out) {
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    Vec3 sum;
    for (size_t b = 0; b < kBoneCount; ++b) {
      if (weights[v][b] > 0) sum += pose[b](mesh.vertices[v]) * weights[v][b];
    }
    for (const double x : {sum.x, sum.y, sum.z}) out.push_back(static_cast<float>(x));
  }
}

/// What is the same in all frames: a texture that each bone's skin is rolled off to, and claws.
struct Coat {
  Coat(const TriangleMesh& mesh, const std::vector<Bone>& bones) {
    std::vector<size_t> bone_of;
    for (const auto& t : mesh.triangles) {
      const Vec3 middle =
          (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) * (1.0 / 3);
      size_t nearest = 0;
      for (size_t b = 1; b < bones.size(); ++b) {
        if (distance_to(bones[b], middle) < distance_to(bones[nearest], middle)) nearest = b;
      }
      bone_of.push_back(nearest);
      const bool foot = nearest >= kFrontLeft && (nearest - kFrontLeft) % 3 == 2;
      claw.push_back(foot && middle.x > bones[nearest].tail.x + 0.015 ? 1 : 0);
    }
    std::vector<UnwrapAxis> axes;
    for (const Bone& bone : bones) axes.push_back({bone.head, bone.tail});
    texture = unwrap(mesh, axes, bone_of);
  }

  std::vector<float> texture;  ///< two numbers for each corner
  std::vector<uint8_t> claw;   ///< of each triangle
};

void add_coat(const Coat& coat, const std::vector<float>& normals, Shot& shot) {
  shot.attributes.push_back(make_attribute("vt", Semantic::kTextureCoordinate, Domain::kCorner,
                                           ValueType::kBinary32, 2, coat.texture));
  shot.attributes.push_back(
      make_attribute("vn", Semantic::kNormal, Domain::kCorner, ValueType::kBinary32, 3, normals));
  shot.attributes.back().animated = true;
  const std::vector<int32_t> material(coat.claw.begin(), coat.claw.end());
  shot.attributes.push_back(
      make_attribute("usemtl", Semantic::kMaterial, Domain::kFace, ValueType::kI32, 1, material));
  shot.attributes.back().names = {"skin", "claw"};
}

}  // namespace

Sequence make_creature(uint32_t frame_count) {
  const std::vector<Bone> bones = make_skeleton();
  const Field field = [&](const Vec3& p) { return body_field(bones, p); };
  const TriangleMesh mesh = isosurface(field, {-1.53, -0.07, -0.43}, {1.29, 1.63, 0.43}, kCell, 8);
  const std::vector<Weights> weights = skin_weights(mesh, bones);

  Sequence sequence;
  Shot& shot = sequence.shots.emplace_back();
  shot.frame_count = frame_count;
  shot.connectivity.vertex_count = static_cast<uint32_t>(mesh.vertices.size());
  shot.connectivity.face_sizes.assign(mesh.triangles.size(), 3);
  for (const auto& t : mesh.triangles) {
    shot.connectivity.corners.insert(shot.connectivity.corners.end(), t.begin(), t.end());
  }
  const Coat coat(mesh, bones);
  std::vector<float> normals;
  shot.positions.reserve(size_t{frame_count} * mesh.vertices.size() * 3);
  for (uint32_t f = 0; f < frame_count; ++f) {
    append_skinned(mesh, weights, pose_at(bones, f / kFramesPerStride), shot.positions);
    append_normals(mesh, coat.claw, shot.frame(f), normals);
  }
  add_coat(coat, normals, shot);
  return sequence;
}

}  // namespace reeb::tools
