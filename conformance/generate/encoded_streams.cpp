// Streams of class *core*: what the encoder makes of small procedural meshes.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "codec/enc/encoder.h"
#include "codec/enc/lossless/stream_encoder.h"
#include "conformance/generate/stream.h"
#include "tests/codec/shapes.h"

namespace reeb::conformance {
namespace {

using namespace reeb::test;

EncodeOptions at(double kg) {
  EncodeOptions o;
  o.target_value = kg;
  o.threads = 1;
  o.regions = 0;
  return o;
}

EncodeOptions with(EncodeOptions o, Profile profile, int regions = 0, uint32_t group_length = 0) {
  o.profile = profile;
  o.regions = regions;
  o.group_length = group_length;
  return o;
}

EncodeOptions bounded(double error) {
  EncodeOptions o = at(error);
  o.target = Target::kMaxError;
  return o;
}

EncodeOptions open_at(uint32_t group_length, uint32_t open_groups) {
  EncodeOptions o = at(0.2);
  o.group_length = group_length;
  o.open_groups = open_groups;
  return o;
}

/// At an effort that tries a weak prior, and with an error that makes them pay.
EncodeOptions weak_prior() {
  EncodeOptions o = open_at(10, 1);
  o.target_value = 0.01;
  o.effort = 6;
  return o;
}

/// Every vertex goes its own way: as many components as there can be.
void scatter(const float* rest, double time, double* xyz) {
  for (int a = 0; a < 3; ++a) {
    const double phase = 12.9898 * rest[0] + 78.233 * rest[1] + 37.719 * rest[2] + 51.1 * a;
    xyz[a] =
        static_cast<double>(rest[a]) +
        static_cast<double>(static_cast<float>(0.2 * std::sin((90 + 9 * phase) * time + phase)));
  }
}

/// Noise: no vertex and no frame tells of another.
void shake(const float* rest, double time, double* xyz) {
  for (int a = 0; a < 3; ++a) {
    const double x = std::sin(1e4 * time + 91.7 * rest[0] + 47.3 * rest[1] + 13.1 * rest[2] + a);
    xyz[a] = static_cast<double>(rest[a]) + std::fmod(static_cast<float>(x) * 4373.7, 0.5);
  }
}

/// Two halves that turn about each other, as regions do.
void fold(const float* rest, double time, double* xyz) {
  const double angle = rest[0] > 0 ? 0.8 * time : -0.5 * time;
  xyz[0] = rest[0];
  xyz[1] = rest[1] * std::cos(angle) - rest[2] * std::sin(angle);
  xyz[2] = rest[1] * std::sin(angle) + rest[2] * std::cos(angle);
}

/// To three decimals, as text files have them.
void bend_in_decimals(const float* rest, double time, double* xyz) {
  bend(rest, time, xyz);
  for (int a = 0; a < 3; ++a) xyz[a] = std::round(xyz[a] * 1000) / 1000;
}

/// Zeros of either sign, subnormals and the largest values among others.
void leap(const float* rest, double time, double* xyz) {
  constexpr double kValues[] = {-0.0, 1e-45, 3.4e38, -1e-40, 1, -3.4028234e38, 0, 1e-20, -77.125};
  const auto i = static_cast<uint32_t>(static_cast<int>(40 * rest[0] + 9 * rest[1]) + 100) +
                 static_cast<uint32_t>(time * 7);
  for (uint32_t a = 0; a < 3; ++a)
    xyz[a] = (i + a) % 3 == 0 ? kValues[(i / 3 + a) % 9] : static_cast<double>(rest[a]);
}

/// Four poses that come back, each for two frames, in 16 frames.
void repeat(const float* rest, double time, double* xyz) {
  bend(rest, static_cast<double>(static_cast<int>(time * 8 + 0.01) % 4) / 4, xyz);
}

/// A few poses, each held for three frames.
void hold(const float* rest, double time, double* xyz) {
  bend(rest, std::floor(time * 11 / 3 + 0.01) / 4, xyz);
}

/// One half never moves.
void wag(const float* rest, double time, double* xyz) { bend(rest, rest[0] > 0 ? time : 0, xyz); }

/// To two decimals and back and forth, by a few steps that differ from vertex to vertex.
void jitter(const float* rest, double time, double* xyz) {
  for (int a = 0; a < 3; ++a) {
    const double x = std::sin(83 * time + 5.1 * rest[0] + 7.3 * rest[1] + 3.7 * rest[2] + a);
    xyz[a] = std::round(static_cast<double>(rest[a]) * 10 + std::fmod(x * 937, 3)) / 100;
  }
}

/// To and fro between far and near, where any error of a weight shows.
void swing(const float* rest, double time, double* xyz) {
  const auto t = static_cast<int>(std::lround(time * 9));
  for (int a = 0; a < 3; ++a) {
    const double near = 1e-3 * static_cast<double>(rest[a]);
    xyz[a] = t % 2 == 0 ? near : 1e6 * static_cast<double>(rest[(a + 1) % 3]);
  }
  if (rest[0] > 3.9f) xyz[0] += t;
}

/// Displacements that grow about 64 times from frame to frame.
void burst(const float* rest, double time, double* xyz) {
  const double growth = 63 + 2 * std::fmod(std::abs(static_cast<double>(rest[0] + rest[1])), 1.0);
  for (int a = 0; a < 3; ++a)
    xyz[a] = static_cast<double>(rest[a]) * (1 + 1e-6 * std::pow(growth, 5 * time));
}

/// Two digits at all powers of ten.
void powers(const float* rest, double time, double* xyz) {
  const auto i = static_cast<int>(std::lround(7 * rest[0] + 31 * rest[1] + 3 * time)) + 400;
  for (int a = 0; a < 3; ++a)
    xyz[a] = (i * (a + 3) % 90 + 10) * std::pow(10.0, i * (2 * a + 1) % 27 - 6) * (i % 2 - 0.5) * 2;
}

/// All vertices stay but those at the outer rim.
void nearly_rest(const float* at, double time, double* xyz) {
  rest(at, time, xyz);
  if (at[0] > 3.9f) xyz[2] += time;
}

/// Stops and goes, vertex by vertex.
void stop_and_go(const float* rest, double time, double* xyz) {
  const double begin = std::fmod(std::abs(static_cast<double>(5 * rest[0] + 3 * rest[1])), 1.0);
  const double steps = std::floor(4 * time + begin);
  for (int a = 0; a < 3; ++a)
    xyz[a] = static_cast<double>(rest[a]) + 0.37 * steps * steps * (a + 1);
}

/// One value that is no decimal among decimals.
Sequence with_stranger(const Shape& shape, uint32_t frames) {
  Sequence s = sequence_of({animate(shape, frames, bend_in_decimals)});
  std::vector<float>& x = s.shots[0].positions;
  for (uint32_t a = 0; a < 3; ++a) x[x.size() / 2 / 3 * 3 + a] = 1.2345678f + static_cast<float>(a);
  return s;
}

/// Every frame on 256 levels an axis, as MD2 files have them: the third on those of the second, the
/// fourth on none, the sixth written as text.
Sequence on_grids(const Shape& shape, uint32_t frames) {
  Sequence s = sequence_of({animate(shape, frames)});
  std::vector<float>& positions = s.shots[0].positions;
  const size_t size = shape.positions.size();
  for (size_t i = 0; i < positions.size(); ++i) {
    const size_t t = i / size, grid = t == 2 ? 1 : t;
    const auto step = static_cast<float>(0.02 * std::sin(1.0 + static_cast<double>(grid)) + 0.03);
    const float origin = -2.1f - 0.01f * static_cast<float>(grid + i % 3);
    const float level = std::round((positions[i] - origin) / step);
    const float scaled = level * step;
    if (t != 3) positions[i] = scaled + origin;
    if (t == 5)
      positions[i] = static_cast<float>(std::round(static_cast<double>(positions[i]) * 1e5) / 1e5);
  }
  return s;
}

Shape shuffled(const Shape& shape) {
  const uint32_t n = shape.connectivity.vertex_count;
  Shape out = shape;
  std::vector<uint32_t> place(n);
  for (uint32_t v = 0; v < n; ++v) {
    place[v] = static_cast<uint32_t>((uint64_t{v} * 7919 + 13) % n);
    for (uint32_t a = 0; a < 3; ++a) out.positions[place[v] * 3 + a] = shape.positions[v * 3 + a];
  }
  for (uint32_t& v : out.connectivity.corners) v = place[v];
  return out;
}

Shape one_triangle() {
  Shape s{.name = "triangle", .connectivity = {}, .positions = {}};
  s.add_vertex(0, 0, 0);
  s.add_vertex(1, 0, 0);
  s.add_vertex(0, 1, 0);
  s.add_face({0, 1, 2});
  return s;
}

void check(const std::string& name, const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "%s: %s\n", name.c_str(), status.message().c_str());
  std::exit(1);
}

class Maker {
 public:
  void add(const char* name, const char* sentence, const Sequence& sequence,
           const EncodeOptions& options) {
    Stream stream{"core", name, sentence, {}};
    EncodeStats stats;
    check(name, encode(sequence, options, stream.bytes, stats));
    streams.push_back(std::move(stream));
  }
  void add(const char* name, const char* sentence, const Shape& shape, uint32_t frames,
           const EncodeOptions& options, const Motion& motion = bend) {
    add(name, sentence, sequence_of({animate(shape, frames, motion)}), options);
  }

  std::vector<Stream> streams;
};

void add_meshes(Maker& m) {
  m.add("single_frame", "One frame of a closed mesh.", torus(12, 8), 1, at(0.2));
  m.add("one_triangle", "One triangle, three frames.", one_triangle(), 3, at(0.2));
  m.add("one_vertex", "One vertex without a face.", single_vertex(), 4, at(0.2));
  m.add("points", "No faces at all: every vertex is coded by its nearest.", points_only(90), 5,
        at(0.5));
  m.add("isolated", "Vertices without faces between others.", with_isolated(torus(8, 6), 5), 5,
        at(0.2));
  m.add("polygons", "Faces of 2 to 6 corners, one of them degenerate.", mixed_polygons(), 6,
        at(0.2));
  m.add("quads", "Quadrilaterals, each two of Draco's triangles.", grid(14, 10), 6, at(0.2));
  m.add("open_strip", "An open strip: every vertex is on the boundary.", strip(40), 6, at(0.2));
  m.add("seam", "Two sheets along a seam of equal positions, and two equal loose vertices.",
        with_duplicates(), 4, at(0.2));
  m.add("fins", "Many triangles at one edge, which Draco splits.", fins(7), 4, at(0.1));
  m.add("hub", "A vertex with 300 triangles, which no collapse looks at.", hub(300), 3, at(0.3));
  m.add("components", "Two components far from each other.", two_components(), 5, at(0.2));
  m.add("order_kept", "Shuffled vertices: the permutation has little to hold on to.",
        shuffled(torus(16, 11)), 4, at(0.3));
  EncodeOptions reorder = at(0.3);
  reorder.reorder = true;
  m.add("order_dropped", "The same mesh in coding order.", shuffled(torus(16, 11)), 4, reorder);
  m.add("valence", "More than a thousand triangles: the other traversal.", torus(36, 16), 2,
        at(0.5));
}

void add_groups(Maker& m) {
  Sequence shots = sequence_of(
      {animate(mixed_polygons(), 6), animate(fins(5), 1), animate(with_duplicates(), 4)});
  m.add("shots", "Three shots, each with its own connectivity.", shots, at(0.2));
  m.add("groups", "Four groups, the last one shorter.", torus(10, 8), 15,
        with(at(0.2), Profile::kMain, 0, 4));
  m.add("groups_of_one", "Every frame is a group.", torus(8, 6), 4,
        with(at(0.2), Profile::kMain, 0, 1));
  m.add("open_groups", "Every group but the first continues the one before.", torus(10, 8), 14,
        open_at(4, 63));
  m.add("weak_prior_groups", "A group with a weak prior, and one that continues it.", torus(24, 14),
        20, weak_prior(), fold);
  m.add("open_runs", "Runs of a group and one that continues it, with regions.", torus(14, 9), 12,
        with(open_at(3, 1), Profile::kMain, 3, 3), fold);
  m.add("static", "Nothing moves: the reference mesh is refined, no time is used.", torus(10, 8), 8,
        at(0.05), rest);
  m.add("long", "160 frames of few vertices that go their own ways: more than 64 components.",
        torus(6, 5), 160, with(at(1), Profile::kMain, 0, 160), scatter);
  m.add("fine", "A small error: large residuals.", torus(12, 9), 6, at(0.001));
  m.add("coarse", "A large error: hardly any residuals.", torus(12, 9), 12, at(3));
  Sequence named = sequence_of({animate(tetrahedron(), 3)});
  named.frame_rate = 23.976;
  named.start_time = -12.5;
  named.metadata = {{"name", "tetrahedron"}, {"unit", "cm"}, {"", "no key"}, {"empty", ""}};
  // Characters of two, three and four bytes, at the ends of what their first bytes can start.
  named.metadata["caf\u00e9"] = "\u0800\ud7ff\uff0d";
  named.metadata["\u0080\u07ff\u0fff\ue000\uffff"] = "\x7F\U0003ffff\U00040000";
  named.metadata["\u20ac"] = "\U00010000\U0001f43e\U000e0041\U0010ffff";
  m.add("metadata", "Frame rate, start time and metadata with letters of one to four bytes.", named,
        at(0.2));
}

void add_profiles(Maker& m) {
  const EncodeOptions fast = with(at(0.2), Profile::kFast);
  m.add("main_one_region", "Motion of one region.", torus(14, 10), 8,
        with(at(0.1), Profile::kMain, 1), fold);
  m.add("main_regions", "Motion of six regions, blended.", torus(20, 12), 10,
        with(at(0.1), Profile::kMain, 6), fold);
  m.add("fast", "Fast profile.", torus(16, 11), 8, with(at(0.1), Profile::kFast));
  m.add("fast_regions", "Fast profile with regions, two groups, open and wary parts.",
        with_isolated(grid(16, 12), 4), 12, with(at(0.1), Profile::kFast, 4, 7), fold);
  m.add("bounded", "Every coordinate's error bounded by corrections.", torus(16, 11), 10,
        bounded(0.002), scatter);
  m.add("bounded_noise", "Noise under a bound: numbers moved to multiples of a step.", torus(9, 7),
        6, bounded(0.01), shake);
  m.add("bounded_groups", "The same in groups, with vertices that are far off.",
        with_isolated(grid(16, 12), 6), 9, with(bounded(0.01), Profile::kFast, 2, 4), fold);
  m.add("fast_polygons", "Faces of many sizes, some not by Draco, in the fast profile.",
        mixed_polygons(), 5, fast);
  m.add("fast_fins", "Split points and loose vertices in the fast profile.",
        with_isolated(fins(7), 5), 4, fast);
  m.add("fast_points", "No faces in the fast profile.", points_only(70), 4, fast);
  m.add("fast_order", "Shuffled vertices in the fast profile.", shuffled(torus(16, 11)), 4, fast);
  EncodeOptions dropped = fast;
  dropped.reorder = true;
  m.add("fast_order_dropped", "The same mesh in coding order.", shuffled(torus(16, 11)), 4,
        dropped);
  m.add("fast_fine", "Many components and large residuals in the fast profile.", torus(10, 8), 12,
        with(at(0.002), Profile::kFast), scatter);
  // No error is relative to the extent of one vertex, which has none.
  EncodeOptions by_rate = fast;
  by_rate.target = Target::kBpvf;
  by_rate.target_value = 2000;
  m.add("fast_vertex", "One vertex in the fast profile.", single_vertex(), 3, by_rate);
  m.add("thesis", "Thesis profile.", torus(12, 8), 5, with(at(0.3), Profile::kThesis));
  m.add("thesis_regions",
        "Thesis profile with regions: transforms follow those of the frame before.", torus(14, 9),
        6, with(at(0.3), Profile::kThesis, 4), fold);
}

/// Many vertices at one place, which stay there, and one that does not.
Shape one_of_many() {
  Shape s{.name = "one of many", .connectivity = {}, .positions = {}};
  s.add_vertex(1, 0, 0);
  for (uint32_t v = 0; v < 4000; ++v) s.add_vertex(0, 0, 0);
  return s;
}

void nudge(const float* rest, double time, double* xyz) {
  for (int a = 0; a < 3; ++a) xyz[a] = static_cast<double>(rest[a]);
  if (xyz[0] > 0.5) xyz[1] += std::floor(8 * time) / 8;
}

void add_lossless(Maker& m) {
  EncodeOptions exact = at(1);
  exact.target = Target::kLossless;
  m.add("lossless", "Every bit of a bending torus.", torus(12, 8), 6, exact);
  m.add("lossless_decimals", "Positions of three decimals.", torus(12, 8), 6, exact,
        bend_in_decimals);
  m.add("lossless_extremes", "Zeros of either sign, subnormals and the largest values.", grid(7, 6),
        5, exact, leap);
  m.add("lossless_repeats", "Poses that come back: frames that are copies.", torus(8, 6), 16, exact,
        repeat);
  m.add("lossless_holds", "Each pose for three frames.", torus(6, 5), 12, exact, hold);
  m.add("lossless_still", "Nothing moves.", torus(8, 6), 5, exact, rest);
  m.add("lossless_parts", "One half never moves.", torus(12, 8), 8, exact, wag);
  m.add("lossless_full",
        "Coded frames that hardly differ, as many as the bytes of the group can hold.",
        one_of_many(), 6, exact, nudge);
  m.add("lossless_points", "No faces.", points_only(40), 4, exact);
  EncodeOptions quick = exact;
  quick.effort = 1;
  m.add("lossless_quick", "The quick method.", torus(12, 8), 14, quick);
  m.add("lossless_quick_extremes", "The quick method on values far from each other.", grid(7, 6), 5,
        quick, leap);
  m.add("lossless_stranger", "Decimals, and values among them that are none.",
        with_stranger(torus(12, 8), 8), exact);
  m.add("lossless_grids",
        "Frames on grids of their own, one on that of the frame before, one on none.",
        on_grids(torus(12, 8), 8), exact);
  m.add("lossless_quick_grids", "The quick method on grids of frames.", on_grids(torus(12, 8), 8),
        quick);
  m.add("lossless_powers", "Two digits at all powers of ten.", torus(10, 6), 4, exact, powers);
  m.add("lossless_jitter", "Steps of a few hundredths, to and fro.", torus(10, 6), 20, exact,
        jitter);
  m.add("lossless_swing", "To and fro between far and near.", torus(8, 5), 10, exact, swing);
  m.add("lossless_burst", "Displacements that grow 64 times from frame to frame.", torus(8, 5), 6,
        exact, burst);
  m.add("lossless_rim", "All vertices stay but those at the rim.", torus(12, 10), 24, exact,
        nearly_rest);
  m.add("lossless_stop_and_go", "Vertices that stop and go.", torus(8, 6), 12, exact, stop_and_go);
  EncodeOptions reorder = exact;
  reorder.reorder = true;
  m.add("lossless_order_dropped", "Every bit, but in coding order.", grid(8, 7), 3, reorder);
  m.add("lossless_vertex", "One vertex: no neighbours at all.", single_vertex(), 6, exact);
  Sequence shots = sequence_of({animate(mixed_polygons(), 7), animate(fins(5), 2)});
  EncodeOptions groups = exact;
  groups.group_length = 3;
  m.add("lossless_shots", "Two shots in groups of three frames.", shots, groups);
}

/// A file that is written as its frames arrive.
Stream open_ended() {
  Stream stream{
      "core", "open_ended", "A file whose HEAD does not know how many frames there are.", {}};
  const Shot shot = animate(torus(8, 6), 7);
  StreamEncoder encoder({.group_length = 3, .threads = 1}, [&](std::span<const uint8_t> bytes) {
    stream.bytes.insert(stream.bytes.end(), bytes.begin(), bytes.end());
    return true;
  });
  constexpr uint32_t kMax = 0xFFFFFFFF;
  const SequenceHeader header = {
      .total_frames = kMax, .shot_count = kMax, .flags = SequenceHeader::kOpenEnded};
  Status status = encoder.begin(header, {});
  if (status.ok()) status = encoder.begin_shot(shot.connectivity);
  for (uint32_t t = 0; t < shot.frame_count && status.ok(); ++t)
    status = encoder.add_frame(shot.frame(t));
  if (status.ok()) status = encoder.finish();
  check(stream.name, status);
  return stream;
}

}  // namespace

std::vector<Stream> encoded_streams() {
  Maker m;
  add_meshes(m);
  add_groups(m);
  add_profiles(m);
  add_lossless(m);
  m.streams.push_back(open_ended());
  return m.streams;
}

}  // namespace reeb::conformance
