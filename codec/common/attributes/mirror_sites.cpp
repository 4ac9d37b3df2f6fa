#include "codec/common/attributes/mirror_sites.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace reeb {

namespace {

constexpr uint32_t kMaxOfRow = 16;  // anchors of three cells in a row that are looked at
constexpr int kKeyBits = 20;

int64_t floor_divide(int64_t a, int64_t b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// Keys rise along the last axis, so that cells in a row are neighbours.
uint64_t key_of(int64_t x, int64_t y, int64_t z) {
  return static_cast<uint64_t>(((x + 2) << kKeyBits | (y + 2)) << kKeyBits | (z + 2));
}

}  // namespace

MirrorSites::MirrorSites(const SiteMesh& sites, MirrorPlane plane) : sites_(sites) {
  sort_cells();
  sort_triangles();
  for (const Cell& c : cells_) {
    std::array<int64_t, 3> point;
    for (size_t i = 0; i < 3; ++i) point[i] = sites.grid[size_t{c.second} * 3 + i];
    point[plane.axis] = int64_t{plane.sum} - point[plane.axis];
    const uint32_t site = nearest(point);
    if (site != kNone) partner_[anchor(c.second)] = anchor(site);
  }
}

// As wide as anchors on a surface are apart, roughly.
void MirrorSites::sort_cells() {
  uint32_t anchors = 0;
  for (uint32_t s = 0; s < sites_.count; ++s) anchors = std::max(anchors, anchor(s) + 1);
  partner_.assign(anchors, kNone);
  if (sites_.count == 0) return;
  int64_t extent = 0;
  for (size_t i = 0; i < 3; ++i) {
    int64_t low = sites_.grid[i], high = low;
    for (size_t s = i; s < sites_.grid.size(); s += 3) {
      low = std::min<int64_t>(low, sites_.grid[s]);
      high = std::max<int64_t>(high, sites_.grid[s]);
    }
    low_[i] = low;
    extent = std::max(extent, high - low);
  }
  int64_t root = 1;
  while ((root + 1) * (root + 1) <= sites_.count) ++root;
  width_ = std::max<int64_t>(extent / root, 1);
  std::vector<bool> seen(anchors);
  for (uint32_t s = 0; s < sites_.count; ++s) {
    if (seen[anchor(s)]) continue;
    seen[anchor(s)] = true;
    const auto cell = [&](size_t i) {
      return floor_divide(sites_.grid[size_t{s} * 3 + i] - low_[i], width_);
    };
    cells_.push_back({key_of(cell(0), cell(1), cell(2)), s});
  }
  std::sort(cells_.begin(), cells_.end());
}

uint32_t MirrorSites::nearest(const std::array<int64_t, 3>& point) const {
  constexpr int64_t kMaxCell = (1 << 16) + 1;
  int64_t cell[3];
  for (size_t i = 0; i < 3; ++i) {
    cell[i] = floor_divide(point[i] - low_[i], width_);
    if (cell[i] < -1 || cell[i] > kMaxCell) return kNone;
  }
  uint32_t out = kNone;
  int64_t least = std::numeric_limits<int64_t>::max();
  for (int64_t row = 0; row < 9; ++row) {
    const int64_t x = cell[0] - 1 + row / 3, y = cell[1] - 1 + row % 3;
    const uint64_t first = key_of(x, y, cell[2] - 1);
    auto c = std::lower_bound(cells_.begin(), cells_.end(), first,
                              [](const Cell& a, uint64_t key) { return a.first < key; });
    for (uint32_t n = 0; n < kMaxOfRow && c != cells_.end() && c->first <= first + 2; ++n, ++c) {
      int64_t distance = 0;
      for (size_t i = 0; i < 3; ++i) {
        const int64_t d = sites_.grid[size_t{c->second} * 3 + i] - point[i];
        distance += d * d;
      }
      if (distance >= least) continue;
      least = distance;
      out = c->second;
    }
  }
  return out;
}

void MirrorSites::sort_triangles() {
  for (uint32_t c = 0; c + 2 < sites_.triangles.size(); c += 3) {
    Triangle t{{}, c};
    for (size_t i = 0; i < 3; ++i) t.anchors[i] = anchor(sites_.triangles[c + i]);
    std::sort(t.anchors.begin(), t.anchors.end());
    triangles_.push_back(t);
  }
  std::sort(triangles_.begin(), triangles_.end(), [](const Triangle& a, const Triangle& b) {
    return std::tie(a.anchors, a.first) < std::tie(b.anchors, b.first);
  });
}

bool MirrorSites::find(const std::array<uint32_t, 3>& sites,
                       std::array<uint32_t, 3>& mirrored) const {
  std::array<uint32_t, 3> wanted;
  for (size_t i = 0; i < 3; ++i) wanted[i] = partner(sites[i]);
  std::array<uint32_t, 3> sorted = wanted;
  std::sort(sorted.begin(), sorted.end());
  if (sorted[2] == kNone || sorted[0] == sorted[1] || sorted[1] == sorted[2]) return false;
  const auto t = std::lower_bound(triangles_.begin(), triangles_.end(), sorted,
                                  [](const Triangle& a, const std::array<uint32_t, 3>& anchors) {
                                    return a.anchors < anchors;
                                  });
  if (t == triangles_.end() || t->anchors != sorted) return false;
  for (size_t i = 0; i < 3; ++i) {
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t site = sites_.triangles[t->first + k];
      if (anchor(site) == wanted[i]) mirrored[i] = site;
    }
  }
  return true;
}

size_t MirrorSites::mirrored_triangles() const {
  size_t out = 0;
  for (size_t c = 0; c + 2 < sites_.triangles.size(); c += 3) {
    const uint32_t* t = &sites_.triangles[c];
    const std::array<uint32_t, 3> own = {t[0], t[1], t[2]};
    std::array<uint32_t, 3> mirrored = own;
    if (find(own, mirrored) && mirrored != own) ++out;
  }
  return out;
}

}  // namespace reeb
