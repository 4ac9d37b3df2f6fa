#include "tools/sample/figures.h"

#include <algorithm>
#include <array>

#include "tools/sample/solid.h"

namespace reeb::tools {
namespace {

constexpr uint32_t kVertices = 5000;
constexpr double kJoint = 0.06;

// SplitMix64 (G. Steele, D. Lea, C. Flood, 2014).
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  double uniform(double low, double high) {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return low + (high - low) * (static_cast<double>(z >> 11) * 0x1p-53);
  }

 private:
  uint64_t state_;
};

// A solid in the making: proportions come from one source of chance, joints from another.
class Builder {
 public:
  Builder(uint64_t individual, uint64_t pose) : build_(individual), pose_(pose) {}

  Solid solid{kJoint};

  double vary(double value, double part = 0.2) {
    return value * build_.uniform(1 - part, 1 + part);
  }
  int choose(int low, int high) {
    return low + std::min(high - low, static_cast<int>(build_.uniform(0, high - low + 1)));
  }
  double turn(double range) { return pose_.uniform(-range, range); }

  void ball(const Vec3& at, double radius) { solid.add_cone(at, at, radius, radius); }
  void cone(const Vec3& from, const Vec3& to, double r, double s) {
    solid.add_cone(from, to, r, s);
  }

  /// A limb of several bones that bends the same way at each of its joints, up to `bend` turns in
  /// all; returns where it ends.
  Vec3 limb(Vec3 from, Vec3 direction, double reach, double r, double s, int bones, double bend) {
    const Pose joint = rotation(0, turn(bend) / bones, {}) * rotation(1, turn(bend) / bones, {}) *
                       rotation(2, turn(bend) / bones, {});
    direction = normalized(direction);
    for (int i = 0; i < bones; ++i) {
      direction = joint(direction);
      const Vec3 to = from + direction * (reach / bones);
      cone(from, to, r + (s - r) * i / bones, r + (s - r) * (i + 1) / bones);
      from = to;
    }
    return from;
  }

  void box(const Vec3& centre, const Vec3& half, double rounding, const Pose& turned = {}) {
    Pose place = turned;
    place.shift = centre;
    solid.add_box(place, half, rounding);
  }

  /// A closed tube about a centre, in the plane of two axes.
  void ring(const Vec3& centre, const Vec3& a, const Vec3& b, double tube, int bones = 20) {
    for (int i = 0; i < bones; ++i) {
      const auto at = [&](int k) {
        const double t = static_cast<double>(k) / bones;
        return centre + a * turn_cosine(t) + b * turn_sine(t);
      };
      cone(at(i), at(i + 1), tube, tube);
    }
  }

 private:
  Random build_, pose_;
};

// Gives the middle of its head.
Vec3 biped(Builder& b, double plump, double leg, double arm) {
  const double chest = b.vary(0.2) * plump, waist = b.vary(0.17) * plump;
  b.cone({0, 0.0, 0}, {0, 0.55, 0}, waist, chest);
  const Vec3 neck =
      b.limb({0, 0.6, 0}, {0, 1, 0}, b.vary(0.22), 0.08 * plump, 0.08 * plump, 1, 0.05);
  const Vec3 head = neck + Vec3{0, 0.1, 0};
  b.ball(head, b.vary(0.15) * (0.6 + 0.4 * plump));
  const double arm_length = b.vary(arm), leg_length = b.vary(leg);
  for (const double side : {1.0, -1.0}) {
    b.limb({0.2 * side * plump, 0.55, 0}, {side, 0.2 + 4 * b.turn(0.2), 0}, arm_length,
           0.08 * plump, 0.055 * plump, 4, 0.22);
    b.limb({0.11 * side * plump, -0.05, 0}, {0.25 * side, -1, 4 * b.turn(0.1)}, leg_length,
           0.11 * plump, 0.07 * plump, 4, 0.15);
  }
  return head;
}

void human(Builder& b) { biped(b, b.vary(1.0, 0.15), 0.9, 0.7); }

void teddy(Builder& b) {
  const Vec3 head = biped(b, b.vary(1.6, 0.15), 0.5, 0.5);
  for (const double side : {1.0, -1.0}) b.ball(head + Vec3{0.13 * side, 0.15, 0}, b.vary(0.08));
}

void armadillo(Builder& b) {
  const Vec3 head = biped(b, b.vary(1.3, 0.12), 0.65, 0.6);
  b.limb({0, 0, -0.15}, {0, -0.2, -1}, b.vary(0.8), 0.12, 0.05, 5, 0.25);
  for (const double side : {1.0, -1.0})
    b.limb(head + Vec3{0.08 * side, 0.1, 0}, {0.7 * side, 1, 0}, b.vary(0.25), 0.07, 0.05, 2, 0.05);
}

void quadruped(Builder& b) {
  const double body = b.vary(0.9, 0.25), leg = b.vary(0.65, 0.3), girth = b.vary(0.22, 0.25);
  b.cone({0, 0, 0}, {body, 0, 0}, girth, girth * b.vary(1.05, 0.1));
  const Vec3 head =
      b.limb({body, 0.08, 0}, {1, b.vary(1.0, 0.6), 0}, b.vary(0.45, 0.4), 0.13, 0.1, 3, 0.1);
  b.cone(head, head + Vec3{b.vary(0.25), -0.06, 0}, b.vary(0.13), 0.07);
  b.limb({-0.1, 0.1, 0}, {-1, 0.1, 0}, b.vary(0.55, 0.4), 0.06, 0.04, 5, 0.3);
  for (const double side : {1.0, -1.0}) {
    for (const double at : {0.05, 0.95})
      b.limb({body * at, -0.1, 0.13 * side}, {4 * b.turn(0.08), -1, 0}, leg, 0.085, 0.055, 3, 0.1);
    b.limb(head + Vec3{0, 0.08, 0.07 * side}, {-0.2, 1, 0.4 * side}, b.vary(0.16), 0.045, 0.035, 1,
           0.02);
  }
}

void bird(Builder& b) {
  b.cone({-0.3, 0, 0}, {0.3, 0.05, 0}, b.vary(0.11), b.vary(0.15));
  const Vec3 head = b.limb({0.35, 0.08, 0}, {1, 0.5, 0}, b.vary(0.25, 0.5), 0.08, 0.07, 2, 0.1);
  b.ball(head, 0.09);
  b.cone(head, head + Vec3{b.vary(0.2), -0.02, 0}, 0.05, 0.025);
  b.box({-0.6, 0.02, 0}, {b.vary(0.22), 0.025, b.vary(0.13)}, 0.02);
  const double span = b.vary(0.5, 0.25), chord = b.vary(0.14), lift = b.turn(0.08);
  for (const double side : {1.0, -1.0})
    b.box({0.05, span * 6 * lift * 0.9, side * (0.1 + span)}, {chord, 0.028, span}, 0.025,
          rotation(0, -side * lift, {}));
}

void fish(Builder& b) {
  const double reach = b.vary(1.2), high = b.vary(0.22, 0.3);
  const double curl = b.turn(0.12);
  Vec3 at{0, 0, 0}, direction{1, 0, 0};
  constexpr int kBones = 8;
  for (int i = 0; i <= kBones; ++i) {
    const double t = static_cast<double>(i) / kBones;
    const double half = high * (0.25 + 3.0 * t * (1 - t));
    b.box(at, {0.11 * reach, half, 0.09 + 0.18 * t * (1 - t)}, 0.08, rotation(1, curl * t, {}));
    direction = rotation(1, curl / kBones, {})(direction);
    at += direction * (reach / kBones);
  }
  b.box(at + direction * 0.1, {0.12, b.vary(0.3), 0.028}, 0.025, rotation(1, curl, {}));
  b.box({0.45 * reach, 1.1 * high, 0}, {b.vary(0.2), b.vary(0.14), 0.028}, 0.025);
}

void octopus(Builder& b) {
  b.cone({0, 0, 0}, {0, b.vary(0.35, 0.3), 0}, b.vary(0.22), b.vary(0.26));
  const double reach = b.vary(1.0, 0.3), thick = b.vary(0.08);
  for (int i = 0; i < 8; ++i) {
    const Vec3 out{turn_cosine(i / 8.0), -0.35, turn_sine(i / 8.0)};
    b.limb(Vec3{out.x * 0.15, -0.05, out.z * 0.15}, out, reach, thick, 0.04, 7, 0.4);
  }
}

void insect(Builder& b, int pairs, bool waist) {
  b.cone({-0.75, 0, 0}, {-0.4, 0.05, 0}, b.vary(0.18), b.vary(0.2));
  b.cone({-0.3, 0, 0}, {0.25, 0, 0}, 0.09, b.vary(0.11));
  if (waist) b.ball({0.45, 0.05, 0}, b.vary(0.15));
  const double reach = b.vary(0.75);
  for (const double side : {1.0, -1.0}) {
    for (int i = 0; i < pairs; ++i) {
      const double along = -0.2 + 0.45 * i / (pairs - 1);
      const Vec3 knee = b.limb({along, 0, 0.06 * side}, {2.4 * along + 4 * b.turn(0.04), 0.6, side},
                               reach * 0.45, 0.05, 0.045, 2, 0.05);
      b.limb(knee, {1.6 * along, -0.9, 0.7 * side}, reach * 0.6, 0.045, 0.035, 2, 0.06);
    }
    if (waist)
      b.limb({0.52, 0.14, 0.06 * side}, {1, 0.6, 0.5 * side}, b.vary(0.4), 0.04, 0.035, 3, 0.15);
  }
}

void ant(Builder& b) { insect(b, 3, true); }
void spider(Builder& b) { insect(b, 4, false); }

void hand(Builder& b) {
  b.box({0, 0, 0}, {b.vary(0.25, 0.1), b.vary(0.27, 0.1), 0.1}, 0.09);
  b.cone({0, -0.3, 0}, {0, -0.55, 0}, b.vary(0.15), b.vary(0.14));
  const double reach = b.vary(0.5);
  constexpr std::array<double, 4> kReach{0.85, 1.0, 0.95, 0.7};
  for (int i = 0; i < 4; ++i) {
    const double x = -0.21 + 0.14 * i;
    b.limb({x, 0.22, 0}, {(x)*0.6, 1, 4 * b.turn(0.03)}, reach * kReach[i], 0.068, 0.055, 3, 0.16);
  }
  b.limb({-0.22, -0.12, 0}, {-1, 0.7, 0}, reach * 0.75, 0.08, 0.06, 3, 0.1);
}

void snake(Builder& b) {
  const Vec3 head = b.limb({0, 0, 0}, {1, 0, 0}, b.vary(1.2), 0.04, 0.1, 8, 0.4);
  const Vec3 front = b.limb(head, {1, 0.1, 0.1}, b.vary(1.2), 0.1, 0.08, 8, 0.4);
  b.ball(front, b.vary(0.12));
}

void star(Builder& b) {
  const double reach = b.vary(0.7), thick = b.vary(0.17);
  for (int i = 0; i < 5; ++i)
    b.limb({0, 0, 0}, {turn_cosine(i / 5.0), 0, turn_sine(i / 5.0)}, reach, thick, 0.06, 4, 0.15);
}

void airplane(Builder& b) {
  const double body = b.vary(1.0, 0.15), girth = b.vary(0.1, 0.25);
  b.cone({-body, 0, 0}, {body, 0, 0}, 0.6 * girth, girth);
  const double span = b.vary(0.45, 0.25), sweep = b.vary(0.06, 0.9), chord = b.vary(0.16, 0.3);
  for (const double side : {1.0, -1.0}) {
    b.box({0.1, 0, side * (0.05 + span)}, {chord, 0.028, span}, 0.025,
          rotation(1, side * sweep, {}));
    b.box({-body + 0.08, 0.02, 0.2 * side}, {0.1, 0.026, b.vary(0.2)}, 0.024,
          rotation(1, side * sweep, {}));
    if (b.choose(0, 1) == 1)
      b.cone({0.05, -0.1, side * span}, {0.3, -0.1, side * span}, 0.05, 0.055);
  }
  b.box({-body + 0.05, 0.2, 0}, {0.1, b.vary(0.18), 0.026}, 0.024);
}

void glasses(Builder& b) {
  const double wide = b.vary(0.32), high = b.vary(0.25), tube = b.vary(0.045, 0.15);
  for (const double side : {1.0, -1.0}) {
    b.ring({side * (wide + 0.07), 0, 0}, {wide, 0, 0}, {0, high, 0}, tube);
    b.limb({side * (2 * wide + 0.07), 0.05, 0}, {0.1 * side + 4 * b.turn(0.06), 0, 1}, b.vary(0.85),
           tube, tube, 3, 0.06);
  }
  b.cone({-0.08, 0.05, 0}, {0.08, 0.05, 0}, tube, tube);
}

void cup(Builder& b) {
  const double radius = b.vary(0.35), high = b.vary(0.8, 0.3), wall = 0.07,
               flare = b.vary(1.1, 0.2);
  b.cone({0, 0, 0}, {0, high, 0}, radius, radius * flare);
  b.solid.carve_cone({0, 0.1, 0}, {0, high + 1, 0}, radius - wall, radius * flare * 1.1 - wall);
  if (b.choose(0, 3) > 0)
    b.ring({radius * (1 + flare) / 2, high * 0.5, 0}, {b.vary(0.25), 0, 0}, {0, b.vary(0.25), 0},
           0.05);
}

void plier(Builder& b) {
  const double open = 0.05 + std::abs(b.turn(0.05)), grip = b.vary(1.0), jaw = b.vary(0.35);
  b.ball({0, 0, 0}, b.vary(0.13));
  for (const double side : {1.0, -1.0}) {
    const Vec3 out{side * turn_sine(open), -turn_cosine(open), 0};
    b.limb({0, 0, 0}, out, grip, 0.07, 0.08, 4, 0.02);
    b.cone({0, 0, 0}, {side * (0.05 + open), jaw, 0}, 0.09, 0.05);
  }
}

void legs_under(Builder& b, double x, double z, double top, double reach, double thick) {
  for (const double sx : {1.0, -1.0}) {
    for (const double sz : {1.0, -1.0})
      b.cone({sx * x, top, sz * z}, {sx * x, top - reach, sz * z}, thick, thick);
  }
}

void table(Builder& b) {
  const double x = b.vary(0.7, 0.3), z = b.vary(0.5, 0.3);
  b.box({0, 0, 0}, {x, 0.045, z}, 0.03);
  if (b.choose(0, 2) > 0) {
    legs_under(b, 0.85 * x, 0.85 * z, 0, b.vary(0.6, 0.3), b.vary(0.05));
  } else {
    b.cone({0, 0, 0}, {0, -0.6, 0}, 0.07, 0.07);
    b.box({0, b.vary(-0.62, 0.1), 0}, {0.5 * x, 0.04, 0.5 * z}, 0.03);
  }
}

void chair(Builder& b) {
  const double x = b.vary(0.4, 0.15), z = b.vary(0.4, 0.15), back = b.vary(0.55, 0.25);
  b.box({0, 0, 0}, {x, 0.045, z}, 0.03);
  legs_under(b, 0.85 * x, 0.85 * z, 0, b.vary(0.6, 0.2), b.vary(0.05));
  if (b.choose(0, 1) == 0) {
    b.box({0, back * 0.5, -0.95 * z}, {x, back * 0.5, 0.04}, 0.03);
  } else {
    for (const double side : {1.0, -1.0})
      b.cone({side * 0.85 * x, 0, -0.9 * z}, {side * 0.85 * x, back, -z}, 0.045, 0.045);
    b.cone({-0.85 * x, back, -z}, {0.85 * x, back, -z}, 0.05, 0.05);
  }
}

void spring(Builder& b) {
  const double turns = b.vary(4.0, 0.3), radius = b.vary(0.4), tube = b.vary(0.06),
               pitch = b.vary(0.22);
  const int bones = static_cast<int>(20 * turns);
  const auto at = [&](int i) {
    const double t = i / 20.0;
    return Vec3{radius * turn_cosine(t), pitch * t, radius * turn_sine(t)};
  };
  for (int i = 0; i < bones; ++i) b.cone(at(i), at(i + 1), tube, tube);
}

void vase(Builder& b) {
  const double belly = b.vary(0.4, 0.3), neck = b.vary(0.18, 0.4), high = b.vary(1.1, 0.3),
               wall = 0.07;
  b.cone({0, 0, 0}, {0, 0.4 * high, 0}, 0.6 * belly, belly);
  b.cone({0, 0.4 * high, 0}, {0, 0.8 * high, 0}, belly, neck);
  b.cone({0, 0.8 * high, 0}, {0, high, 0}, neck, neck * 1.2);
  b.solid.carve_cone({0, 0.8 * high, 0}, {0, high + 0.5, 0}, neck - wall, neck * 1.3 - wall * 0.6);
  if (b.choose(0, 2) == 0) {
    b.ring({1.1 * neck + 0.1, 0.75 * high, 0}, {0.18, 0, 0}, {0, 0.2, 0}, 0.045);
    b.ring({-1.1 * neck - 0.1, 0.75 * high, 0}, {0.18, 0, 0}, {0, 0.2, 0}, 0.045);
  }
}

void bearing(Builder& b) {
  const double radius = b.vary(0.45), high = b.vary(0.2, 0.6), hole = b.vary(0.25, 0.3);
  b.cone({0, -high, 0}, {0, high, 0}, radius, radius);
  b.solid.carve_cone({0, -3, 0}, {0, 3, 0}, hole, hole);
  if (b.choose(0, 1) == 1) b.box({0, -high, 0}, {b.vary(0.8, 0.15), 0.08, 0.35}, 0.05);
}

void mechanic(Builder& b) {
  const double x = b.vary(0.6, 0.3), z = b.vary(0.4, 0.3), y = b.vary(0.18, 0.4);
  b.box({0, 0, 0}, {x, y, z}, 0.04);
  b.box({-0.6 * x, y + 0.2, 0}, {0.1, b.vary(0.3), z}, 0.04);
  const int holes = b.choose(1, 3);
  for (int i = 0; i < holes; ++i) {
    const double at = -0.3 * x + 0.55 * x * i;
    b.solid.carve_cone({at, -3, 0}, {at, 3, 0}, 0.14, 0.14);
  }
}

void bust(Builder& b) {
  b.cone({-0.25, 0, 0}, {0.25, 0, 0}, b.vary(0.2), 0.2);
  b.box({0, -0.15, 0}, {b.vary(0.5), 0.16, b.vary(0.22)}, 0.14);
  b.cone({0, 0.1, 0}, {0, 0.4, 0.03}, b.vary(0.14), 0.13);
  b.cone({0, 0.5, 0.05}, {0, 0.7, 0.03}, b.vary(0.19), b.vary(0.22));
  b.cone({0, 0.52, 0.2}, {0, 0.5, 0.3}, 0.05, 0.045);
}

struct Kind {
  const char* name;
  void (*build)(Builder&);
};

constexpr std::array<Kind, 23> kKinds{{
    {"airplane", airplane},   {"ant", ant},         {"armadillo", armadillo},
    {"bearing", bearing},     {"bird", bird},       {"bust", bust},
    {"chair", chair},         {"cup", cup},         {"fish", fish},
    {"glasses", glasses},     {"hand", hand},       {"human", human},
    {"mechanic", mechanic},   {"octopus", octopus}, {"plier", plier},
    {"quadruped", quadruped}, {"snake", snake},     {"spider", spider},
    {"spring", spring},       {"star", star},       {"table", table},
    {"teddy", teddy},         {"vase", vase},
}};

Shot shot_of(const TriangleMesh& mesh) {
  Shot shot;
  shot.frame_count = 1;
  shot.connectivity.vertex_count = static_cast<uint32_t>(mesh.vertices.size());
  shot.connectivity.face_sizes.assign(mesh.triangles.size(), 3);
  for (const auto& t : mesh.triangles)
    shot.connectivity.corners.insert(shot.connectivity.corners.end(), t.begin(), t.end());
  for (const Vec3& p : mesh.vertices) {
    for (const double x : {p.x, p.y, p.z}) shot.positions.push_back(static_cast<float>(x));
  }
  return shot;
}

}  // namespace

const std::vector<std::string>& figure_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    list.reserve(std::size(kKinds));
    for (const Kind& kind : kKinds) list.emplace_back(kind.name);
    return list;
  }();
  return names;
}

Sequence make_figure(const std::string& kind, uint32_t individual, uint32_t frame_count) {
  Sequence sequence;
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return kind == k.name; });
  for (uint32_t f = 0; f < frame_count; ++f) {
    const uint64_t seed = uint64_t{individual} << 32;
    Builder builder(seed, seed + f + 1);
    found->build(builder);
    sequence.shots.push_back(shot_of(builder.solid.surface(kVertices)));
  }
  return sequence;
}

}  // namespace reeb::tools
