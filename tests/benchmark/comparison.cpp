#include "tests/benchmark/comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace reeb::benchmark {
namespace {

double pairs(double n) { return n * (n - 1) / 2; }

}  // namespace

double rand_index(std::span<const uint32_t> a, std::span<const uint32_t> b) {
  std::map<std::pair<uint32_t, uint32_t>, double> both;
  std::map<uint32_t, double> in_a, in_b;
  for (size_t v = 0; v < a.size(); ++v) {
    ++both[{a[v], b[v]}];
    ++in_a[a[v]];
    ++in_b[b[v]];
  }
  const double all = pairs(static_cast<double>(a.size()));
  double agreeing = all;
  for (const auto& [labels, n] : both) agreeing += 2 * pairs(n);
  for (const auto& [label, n] : in_a) agreeing -= pairs(n);
  for (const auto& [label, n] : in_b) agreeing -= pairs(n);
  return all > 0 ? agreeing / all : 1;
}

ExtremityMatcher::ExtremityMatcher(std::span<const float> positions,
                                   std::span<const uint32_t> triangles)
    : pieces_(segmentation::split_pieces(positions, triangles, true)) {}

bool ExtremityMatcher::same(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b,
                            double radius) const {
  return a.size() == b.size() && covers(a, b, radius) && covers(b, a, radius);
}

bool ExtremityMatcher::covers(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b,
                              double radius) const {
  return std::all_of(b.begin(), b.end(), [&](uint32_t v) {
    const uint32_t piece = pieces_.piece[v];
    if (piece == segmentation::kNone) return false;
    const segmentation::Surface& surface = pieces_.surfaces[piece];
    const double reach = radius * std::sqrt(segmentation::total_area(surface));
    const std::vector<double> distance =
        segmentation::edge_distances(surface, pieces_.local[v], reach);
    return std::any_of(a.begin(), a.end(), [&](uint32_t w) {
      return pieces_.piece[w] == piece && distance[pieces_.local[w]] <= reach;
    });
  });
}

}  // namespace reeb::benchmark
