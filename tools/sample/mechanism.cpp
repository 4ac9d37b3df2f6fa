#include <array>
#include <utility>
#include <vector>

#include "tools/io/attribute_values.h"
#include "tools/sample/sample.h"
#include "tools/vec3.h"

namespace reeb::tools {
namespace {

using Outline = std::vector<std::pair<double, double>>;  // counter-clockwise in x, y

constexpr double kModule = 0.05;        ///< pitch diameter per tooth
constexpr double kFramesPerTurn = 120;  ///< of the crank gear
constexpr double kCrankRadius = 0.30;
constexpr double kRodLength = 1.25;

/// Parts that move rigidly, one after another in the vertex order.
class Assembly {
 public:
  /// Between two outlines of equal length, from z = low to z = high; gives the index of the part.
  size_t add_ring(const Outline& outer, const Outline& inner, double low, double high) {
    const uint32_t first = begin_part();
    const auto n = static_cast<uint32_t>(outer.size());
    add_layer(outer, low);
    add_layer(outer, high);
    add_layer(inner, high);
    add_layer(inner, low);
    // Round the section: outside, top, inside, bottom.
    for (uint32_t side = 0; side < 4; ++side) {
      for (uint32_t i = 0; i < n; ++i) {
        const uint32_t j = (i + 1) % n;
        const uint32_t here = first + side * n;
        const uint32_t there = first + (side + 1) % 4 * n;
        add_face({here + i, here + j, there + j, there + i});
      }
    }
    return part_first_.size() - 1;
  }

  /// A solid over an outline that its centre sees.
  size_t add_solid(const Outline& outline, const std::pair<double, double>& centre, double low,
                   double high) {
    const uint32_t first = begin_part();
    const auto n = static_cast<uint32_t>(outline.size());
    add_layer(outline, low);
    add_layer(outline, high);
    add_layer({centre}, low);
    add_layer({centre}, high);
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t j = (i + 1) % n;
      add_face({first + i, first + j, first + n + j, first + n + i});
      add_face({first + 2 * n, first + j, first + i});
      add_face({first + 2 * n + 1, first + n + i, first + n + j});
    }
    return part_first_.size() - 1;
  }

  const Connectivity& connectivity() const { return connectivity_; }
  /// Part of each vertex, and of each face.
  std::vector<size_t> parts_of_vertices() const {
    std::vector<size_t> out;
    for (size_t part = 0; part < part_first_.size(); ++part)
      out.resize(part + 1 < part_first_.size() ? part_first_[part + 1] : rest_.size(), part);
    return out;
  }
  const std::vector<int32_t>& parts_of_faces() const { return part_of_face_; }
  size_t part_count() const { return part_first_.size(); }

  void append_frame(const std::vector<Pose>& pose_of_part, std::vector<float>& out) const {
    for (size_t part = 0; part < part_first_.size(); ++part) {
      const size_t end = part + 1 < part_first_.size() ? part_first_[part + 1] : rest_.size();
      for (size_t v = part_first_[part]; v < end; ++v) {
        const Vec3 p = pose_of_part[part](rest_[v]);
        for (const double x : {p.x, p.y, p.z}) out.push_back(static_cast<float>(x));
      }
    }
  }

 private:
  uint32_t begin_part() {
    part_first_.push_back(rest_.size());
    return static_cast<uint32_t>(rest_.size());
  }
  void add_layer(const Outline& outline, double z) {
    for (const auto& [x, y] : outline) rest_.push_back({x, y, z});
    connectivity_.vertex_count = static_cast<uint32_t>(rest_.size());
  }
  void add_face(std::initializer_list<uint32_t> corners) {
    connectivity_.face_sizes.push_back(static_cast<uint32_t>(corners.size()));
    connectivity_.corners.insert(connectivity_.corners.end(), corners);
    part_of_face_.push_back(static_cast<int32_t>(part_first_.size() - 1));
  }

  std::vector<Vec3> rest_;
  std::vector<size_t> part_first_;
  std::vector<int32_t> part_of_face_;
  Connectivity connectivity_;
};

Outline circle(double radius, int points) {
  Outline out;
  for (int i = 0; i < points; ++i) {
    const double turns = static_cast<double>(i) / points;
    out.emplace_back(radius * turn_cosine(turns), radius * turn_sine(turns));
  }
  return out;
}

double pitch_radius(int teeth) { return 0.5 * kModule * teeth; }

constexpr int kPointsPerTooth = 8;

// Trapezoidal teeth, the middle of the first at angle 0.
Outline gear_outline(int teeth) {
  constexpr std::pair<double, double> kTooth[kPointsPerTooth] = {
      {-0.30, -1.1}, {-0.22, 0.0}, {-0.13, 0.9}, {-0.04, 0.9},
      {0.04, 0.9},   {0.13, 0.9},  {0.22, 0.0},  {0.30, -1.1}};
  Outline out;
  for (int tooth = 0; tooth < teeth; ++tooth) {
    for (const auto& [along, height] : kTooth) {
      const double turns = (tooth + along) / teeth;
      const double r = pitch_radius(teeth) + 0.5 * kModule * height;
      out.emplace_back(r * turn_cosine(turns), r * turn_sine(turns));
    }
  }
  return out;
}

size_t add_gear(Assembly& assembly, int teeth) {
  return assembly.add_ring(gear_outline(teeth),
                           circle(0.3 * pitch_radius(teeth), kPointsPerTooth * teeth), -0.08, 0.08);
}

// A bar from (0, 0) to (length, 0) with round ends.
Outline bar_outline(double bar_length, double radius) {
  constexpr int kHalf = 16;
  Outline out;
  for (int i = 0; i <= 2 * kHalf; ++i) {
    const double turns = -0.25 + 0.5 * i / (2 * kHalf);
    out.emplace_back(bar_length + radius * turn_cosine(turns), radius * turn_sine(turns));
  }
  for (int i = 0; i <= 2 * kHalf; ++i) {
    const double turns = 0.25 + 0.5 * i / (2 * kHalf);
    out.emplace_back(radius * turn_cosine(turns), radius * turn_sine(turns));
  }
  return out;
}

Pose moved(double x, double y, double z) {
  Pose pose;
  pose.shift = {x, y, z};
  return pose;
}

struct Parts {
  size_t crank_gear, second_gear, third_gear, crank_pin, rod, piston, sleeve;
};

constexpr int kCrankTeeth = 28;
constexpr int kSecondTeeth = 16;
constexpr int kThirdTeeth = 20;

Parts build(Assembly& assembly) {
  Parts parts{};
  parts.crank_gear = add_gear(assembly, kCrankTeeth);
  parts.second_gear = add_gear(assembly, kSecondTeeth);
  parts.third_gear = add_gear(assembly, kThirdTeeth);
  parts.crank_pin = assembly.add_solid(circle(0.06, 32), {0, 0}, 0.09, 0.3);
  parts.rod = assembly.add_solid(bar_outline(kRodLength, 0.1), {0.5 * kRodLength, 0}, 0.14, 0.24);
  // Drawn along z; turned into x when posed.
  parts.piston = assembly.add_solid(circle(0.2, 64), {0, 0}, 0.11, 0.45);
  parts.sleeve = assembly.add_ring(circle(0.28, 64), circle(0.22, 64), 0.0, 0.85);
  return parts;
}

// Gears mesh where a tooth of one meets a gap of the other on the line of their centres.
std::vector<Pose> pose_at(const Assembly& assembly, const Parts& parts, double crank) {
  std::vector<Pose> pose(assembly.part_count());
  const Vec3 origin;
  pose[parts.crank_gear] = rotation(2, crank, origin);

  const double second_y = pitch_radius(kCrankTeeth) + pitch_radius(kSecondTeeth);
  const double second = -crank * kCrankTeeth / kSecondTeeth + 0.5 / kSecondTeeth;
  pose[parts.second_gear] = moved(0, second_y, 0) * rotation(2, second, origin);
  const double third_x = -pitch_radius(kSecondTeeth) - pitch_radius(kThirdTeeth);
  const double third = crank * kCrankTeeth / kThirdTeeth;
  pose[parts.third_gear] = moved(third_x, second_y, 0) * rotation(2, third, origin);

  const double pin_x = kCrankRadius * turn_cosine(crank);
  const double pin_y = kCrankRadius * turn_sine(crank);
  pose[parts.crank_pin] = moved(pin_x, pin_y, 0);
  const double reach = std::sqrt(kRodLength * kRodLength - pin_y * pin_y);
  Pose rod = moved(pin_x, pin_y, 0);
  const double c = reach / kRodLength;
  const double s = -pin_y / kRodLength;
  rod.rows = {Vec3{c, -s, 0}, Vec3{s, c, 0}, Vec3{0, 0, 1}};
  pose[parts.rod] = rod;

  Pose along_x;
  along_x.rows = {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  pose[parts.piston] = moved(pin_x + reach, 0, 0.19) * along_x;
  pose[parts.sleeve] = moved(kRodLength - 0.1, 0, 0.19) * along_x;
  return pose;
}

/// Groups, and a colour for each.
void paint(const Assembly& assembly, Shot& shot) {
  struct Paint {
    const char* name;
    std::array<float, 3> colour;
  };
  // In the order of `build`; fractions of 255.
  static constexpr std::array<Paint, 7> kPaints{{{"crank gear", {0.2f, 0.4f, 0.6f}},
                                                 {"second gear", {0.8f, 0.4f, 0.2f}},
                                                 {"third gear", {0.4f, 0.6f, 0.2f}},
                                                 {"crank pin", {0.2f, 0.2f, 0.2f}},
                                                 {"rod", {0.8f, 0.6f, 0.2f}},
                                                 {"piston", {0.6f, 0.6f, 0.6f}},
                                                 {"sleeve", {0.4f, 0.4f, 0.6f}}}};
  std::vector<float> colours;
  for (const size_t part : assembly.parts_of_vertices())
    colours.insert(colours.end(), kPaints[part].colour.begin(), kPaints[part].colour.end());
  shot.attributes.push_back(make_attribute("color", Semantic::kColour, Domain::kVertex,
                                           ValueType::kBinary32, 3, colours));
  shot.attributes.push_back(make_attribute("g", Semantic::kGroup, Domain::kFace, ValueType::kI32, 1,
                                           assembly.parts_of_faces()));
  for (const Paint& p : kPaints) shot.attributes.back().names.emplace_back(p.name);
}

}  // namespace

Sequence make_mechanism(uint32_t frame_count) {
  Assembly assembly;
  const Parts parts = build(assembly);
  Sequence sequence;
  Shot& shot = sequence.shots.emplace_back();
  shot.connectivity = assembly.connectivity();
  shot.frame_count = frame_count;
  for (uint32_t f = 0; f < frame_count; ++f) {
    assembly.append_frame(pose_at(assembly, parts, f / kFramesPerTurn), shot.positions);
  }
  paint(assembly, shot);
  return sequence;
}

}  // namespace reeb::tools
