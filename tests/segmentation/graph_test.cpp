// Feature points, sweep, simplification and cut on shapes and graphs whose answer is known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>

#include "segmentation/feature_points.h"
#include "segmentation/graph_simplification.h"
#include "segmentation/reeb_graph.h"
#include "segmentation/region_cut.h"
#include "tests/segmentation/shapes.h"

using namespace reeb::segmentation;

namespace {

// Height in a direction.
std::vector<double> heights(const Surface& surface, const Point& direction) {
  std::vector<double> f;
  for (const Point& p : surface.points) f.push_back(p.dot(direction));
  return f;
}

uint32_t loops(const ReebGraph& graph, uint32_t components) {
  return static_cast<uint32_t>(graph.arcs.size() + components - graph.nodes.size());
}

std::vector<NodeType> types(const ReebGraph& graph) {
  std::vector<NodeType> result;
  for (const ReebNode& node : graph.nodes) result.push_back(node.type);
  return result;
}

// Nodes in the order given, arcs between them.
ReebGraph graph_of(const std::vector<double>& values, const std::vector<ReebArc>& arcs) {
  ReebGraph graph;
  for (uint32_t i = 0; i < values.size(); ++i) {
    graph.nodes.push_back({i, values[i], NodeType::kSaddle});
  }
  graph.arcs = arcs;
  return graph;
}

}  // namespace

TEST_CASE("peaks count when they stand out") {
  // Heights along the first row of a strip, 9 3 5 2 8 7 7.5 1 6; the second row lies lower
  // throughout.
  const Surface strip = shapes::surface_of(shapes::square(8, 8));
  Eigen::VectorXd f = Eigen::VectorXd::Constant(strip.vertex_count(), -1);
  f.head(9) << 9, 3, 5, 2, 8, 7, 7.5, 1, 6;
  // Rises above the pass to a higher peak: 9 whole range, 5: 2, 8: 6, 7.5: 0.5, 6: 5.
  CHECK(persistent_maxima(strip, f, 0.1) == std::vector<uint32_t>{0, 2, 4, 6, 8});
  CHECK(persistent_maxima(strip, f, 1) == std::vector<uint32_t>{0, 2, 4, 8});
  CHECK(persistent_maxima(strip, f, 5.5) == std::vector<uint32_t>{0, 4});
  CHECK(persistent_maxima(strip, f, 100) == std::vector<uint32_t>{0});
}

TEST_CASE("the farthest pair of points on a line are its ends") {
  Eigen::MatrixXd embedding(2, 6);
  embedding << 3, -4, 1, 8, 2, 5, 0, 0, 0, 0, 0, 0;
  auto pair = farthest_pair(embedding);
  std::sort(pair.begin(), pair.end());
  CHECK(pair == std::array<uint32_t, 2>{1, 3});
}

TEST_CASE("the height of a sphere has one arc") {
  const Surface sphere = shapes::surface_of(shapes::ellipsoid(3, 1, 1, 1));
  const ReebGraph graph = sweep_reeb_graph(sphere, heights(sphere, {0.1, 0.2, 1}));
  CHECK(types(graph) == std::vector{NodeType::kMinimum, NodeType::kMaximum});
  CHECK(graph.arcs.size() == 1);
  CHECK(std::all_of(graph.vertex_arc.begin(), graph.vertex_arc.end(),
                    [](uint32_t arc) { return arc == 0; }));
}

TEST_CASE("a standing torus has a bottom, two saddles around its hole and a top") {
  const Surface torus = shapes::surface_of(shapes::torus(40, 20, 2, 0.5));
  const ReebGraph graph = sweep_reeb_graph(torus, heights(torus, {1, 0.01, 0.02}));
  CHECK(types(graph) ==
        std::vector{NodeType::kMinimum, NodeType::kSaddle, NodeType::kSaddle, NodeType::kMaximum});
  REQUIRE(graph.arcs.size() == 4);
  CHECK(graph.nodes[0].value == Approx(-2.5).margin(0.05));
  CHECK(graph.nodes[1].value == Approx(-1.5).margin(0.05));
  CHECK(graph.nodes[2].value == Approx(1.5).margin(0.05));
  CHECK(graph.nodes[3].value == Approx(2.5).margin(0.05));
  CHECK((graph.arcs[1].low == 1 && graph.arcs[1].high == 2));
  CHECK((graph.arcs[2].low == 1 && graph.arcs[2].high == 2));
}

TEST_CASE("loops equal the genus for any function") {
  const auto three_rings = [](const Point& p) {
    double value = 1e9;
    for (const double x : {-1.7, 0.0, 1.7}) {
      const double r = std::hypot(p.x() - x, p.y()) - 0.8;
      value = std::min(value, std::hypot(r, p.z()) - 0.3);
    }
    return value;
  };
  const shapes::Mesh mesh = shapes::implicit_surface(three_rings, 3, 50);
  REQUIRE(shapes::euler_characteristic(mesh) == 2 - 2 * 3);
  const Surface surface = shapes::surface_of(mesh);
  for (int i = 0; i < 12; ++i) {
    const Point direction(std::cos(i), std::sin(i), std::cos(2.0 * i));
    std::vector<double> f = heights(surface, direction);
    for (uint32_t v = 0; v < f.size(); ++v) f[v] += 0.05 * i * std::sin(7.0 * v);  // ever rougher
    const ReebGraph graph = sweep_reeb_graph(surface, f);
    CHECK(loops(graph, 1) == 3);
    const std::vector<bool> none(graph.nodes.size(), false);
    const SimplifiedGraph simple = simplify(graph, none, 0.3);
    CHECK(simple.arcs.size() + 1 - simple.nodes.size() == 3);
    CHECK(simple.arcs.size() <= graph.arcs.size());
  }
}

TEST_CASE("boundaries and fans of triangles are swept as well") {
  const Surface cylinder = shapes::surface_of(shapes::open_cylinder(16, 10, 1, 5));
  CHECK(loops(sweep_reeb_graph(cylinder, heights(cylinder, {0.05, 0.02, 1})), 1) == 0);
  // From the side the open cylinder is a band of two sheets joined at both sides: a loop.
  CHECK(loops(sweep_reeb_graph(cylinder, heights(cylinder, {1, 0.01, 0.001})), 1) == 1);
  Surface book;
  book.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 2}, {-1, 0, 3}, {0, 1, 4}};
  book.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  connect(book);
  const ReebGraph graph = sweep_reeb_graph(book, heights(book, {0, 0, 1}));
  CHECK(graph.nodes.size() == 5);  // bottom, spine, and the three pages end apart
  CHECK(graph.arcs.size() == 4);
}

TEST_CASE("a vertex of very many triangles is passed in their number's time", "[hostile]") {
  const Surface fan = shapes::surface_of(shapes::cone(200000));
  // Up one half of the rim and down the other, the middle in between.
  std::vector<double> f{50000.25};
  for (int i = 0; i < 200000; ++i) f.push_back(i < 100000 ? i : 200000 - i - 0.5);
  const std::clock_t start = std::clock();
  const ReebGraph graph = sweep_reeb_graph(fan, f);
  CHECK(types(graph) == std::vector{NodeType::kMinimum, NodeType::kMaximum});
  CHECK(std::clock() - start < 5 * CLOCKS_PER_SEC);  // 30 s where each is compared with each
}

TEST_CASE("equal values are ordered by index and end in a valid graph") {
  const Surface sphere = shapes::surface_of(shapes::ellipsoid(2, 1, 1, 1));
  const ReebGraph graph = sweep_reeb_graph(sphere, std::vector<double>(sphere.vertex_count(), 1.0));
  CHECK(loops(graph, 1) == 0);
  for (const ReebArc& arc : graph.arcs) CHECK(arc.low < arc.high);
}

TEST_CASE("short arcs to extrema are dropped and their nodes dissolve") {
  // A chain 0 - 1 - 3 with a short spike 1 - 2.
  const ReebGraph graph = graph_of({0, 0.5, 0.55, 1}, {{0, 1}, {1, 2}, {1, 3}});
  const std::vector<bool> none(4, false);
  const SimplifiedGraph whole = simplify(graph, none, 0.01);
  CHECK(whole.arcs.size() == 3);
  CHECK(whole.arc_of == std::vector<uint32_t>{0, 1, 2});
  const SimplifiedGraph cut = simplify(graph, none, 0.1);
  REQUIRE(cut.arcs.size() == 1);
  CHECK(cut.nodes.size() == 2);
  CHECK(cut.arcs[0].length == Approx(1));
  CHECK(cut.arc_of == std::vector<uint32_t>{0, 0, 0});  // the spike's vertices join the chain
}

TEST_CASE("a kept extremum holds its arc") {
  const ReebGraph graph = graph_of({0, 0.5, 0.55, 1}, {{0, 1}, {1, 2}, {1, 3}});
  CHECK(simplify(graph, {false, false, true, false}, 0.1).arcs.size() == 3);
}

TEST_CASE("short arcs between saddles are contracted into a branching") {
  // Two minima join at 2, two more arcs leave at 3; 2 - 3 is short.
  const ReebGraph graph =
      graph_of({0, 0.1, 0.6, 0.62, 0.9, 1}, {{0, 2}, {1, 2}, {2, 3}, {3, 4}, {3, 5}});
  const SimplifiedGraph simple = simplify(graph, std::vector<bool>(6, false), 0.05);
  REQUIRE(simple.arcs.size() == 4);
  CHECK(simple.nodes.size() == 5);
  REQUIRE(simple.arc_of[2] == kNone);
  const uint32_t centre = simple.node_of[2];
  CHECK(simple.degree(centre) == 4);
  // Each arc remembers the value at which it reached the branching.
  for (const auto& arc : simple.arcs) {
    const double value = arc.from == centre ? arc.from_value : arc.to_value;
    CHECK((value == 0.6 || value == 0.62));
  }
}

TEST_CASE("a loop survives any threshold") {
  const ReebGraph graph = graph_of({0, 0.5, 0.51, 1}, {{0, 1}, {1, 2}, {1, 2}, {2, 3}});
  const SimplifiedGraph simple = simplify(graph, std::vector<bool>(4, false), 10);
  CHECK(simple.arcs.size() + 1 - simple.nodes.size() == 1);
}

TEST_CASE("borders fall into the creases between a body and its arms") {
  std::vector<Point> tips;
  for (int i = 0; i < 3; ++i)
    tips.emplace_back(1.8 * std::cos(2.1 * i), 1.8 * std::sin(2.1 * i), 0);
  const auto star = [&](const Point& p) {
    double value = p.norm() - 0.6;
    for (const Point& tip : tips) {
      value = std::min(value, shapes::capsule(p, Point::Zero(), tip, 0.25));
    }
    return value;
  };
  const shapes::Mesh mesh = shapes::implicit_surface(star, 2.2, 50);
  // Vertices of the body beyond the creases, and vertices of arms on the ball, above where arms
  // reach.
  const auto misplaced = [&](double window) {
    Options options;
    options.border_window = window;
    const Result result = segment(mesh.positions, mesh.triangles, options);
    REQUIRE(result.graph.arcs.size() == 3);
    uint32_t body = kNoRegion;
    for (const Node& node : result.graph.nodes) body = std::min(body, node.region);
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const Point p(mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]);
      count += p.norm() > 0.7 && result.labels[v] == body;
      count += std::abs(p.z()) > 0.35 && result.labels[v] != body;
    }
    return count;
  };
  CHECK(misplaced(0) > 200);
  CHECK(misplaced(Options().border_window) < 10);
  CHECK(misplaced(0.3) < 40);
}
