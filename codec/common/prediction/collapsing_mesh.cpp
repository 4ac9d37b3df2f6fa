#include "codec/common/prediction/collapsing_mesh.h"

namespace reeb {

namespace {
constexpr uint32_t kNoFace = UINT32_MAX;
}

CollapsingMesh::CollapsingMesh(const GridPoints& points, std::span<const uint32_t> triangles,
                               uint32_t growth)
    : points_(points),
      none_(points.size()),
      neighbours_({}, none_),
      faces_({}, kNoFace),
      edges_(points.size(), 0),
      marked_(points.size() + 1) {
  Indices face_count(points.size(), 0);
  for (const uint32_t v : triangles) ++face_count[v];
  const auto crowded = [&](uint32_t v) { return face_count[v] > kMaxFaces; };
  triangles_.reserve(triangles.size() / 3);
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Triangle t = {triangles[i], triangles[i + 1], triangles[i + 2]};
    if (std::none_of(t.begin(), t.end(), crowded)) triangles_.push_back(t);
  }
  make_lists(growth);
}

void CollapsingMesh::make_lists(uint32_t growth) {
  Indices room(points_.size(), 0);
  for (const Triangle& t : triangles_) {
    for (const uint32_t v : t) room[v] += 2;
  }
  neighbours_ = NeighbourLists(room, none_);
  for (uint32_t& r : room) r = r / 2 + growth;
  faces_ = NeighbourLists(room, kNoFace);
  for (uint32_t f = 0; f < triangles_.size(); ++f) {
    const Triangle& t = triangles_[f];
    for (uint32_t i = 0; i < 3; ++i) {
      faces_.push_back(t[i], f);
      neighbours_.push_back(t[i], t[(i + 1) % 3]);
      neighbours_.push_back(t[i], t[(i + 2) % 3]);
    }
  }
  for (uint32_t v = 0; v < points_.size(); ++v) {
    marked_.clear();
    neighbours_.filter(v, [&](uint32_t u) { return marked_.add(u); });
    for (const uint32_t u : neighbours_[v]) edges_[v] += points_.distance_q4(v, u);
  }
}

uint32_t CollapsingMesh::shared_faces(uint32_t v, uint32_t u) const {
  uint32_t count = 0;
  for (const uint32_t f : faces_[v]) count += has(triangles_[f], u) ? 1 : 0;
  return count;
}

void CollapsingMesh::merge(uint32_t v, std::span<const uint32_t> near, uint32_t target) {
  move_faces(v, target);
  marked_.clear();
  for (const uint32_t u : neighbours_.by_eights(target)) marked_.mark(u);
  for (const uint32_t w : near) {
    const bool erases = (same(w, target) | (marked_.has(w) ? 1u : 0u)) != 0;
    neighbours_.replace_or_erase(w, v, target, erases);
    neighbours_.push_back_if(!erases, target, w);
    const uint32_t added = erases ? 0 : points_.distance_q4(w, target);
    edges_[w] += added - points_.distance_q4(w, v);
    edges_[target] += added;
  }
}

/// The target takes the place of v in its triangles; those that it has are gone.
void CollapsingMesh::move_faces(uint32_t v, uint32_t target) {
  const std::span<const uint32_t> faces = faces_[v];
  moved_.resize(std::max(moved_.size(), faces.size() + 1));
  gone_.resize(moved_.size());
  size_t moved_count = 0, gone_count = 0;
  for (const uint32_t f : faces) {
    Triangle& t = triangles_[f];
    const uint32_t keeps = has(t, target) ? 0 : 1;
    for (uint32_t& corner : t) {
      const uint32_t moves = keeps & same(corner, v);
      corner ^= (corner ^ target) & (0u - moves);
    }
    moved_[moved_count] = gone_[gone_count] = f;
    moved_count += keeps;
    gone_count += 1 - keeps;
  }
  for (size_t i = 0; i < moved_count; ++i) faces_.push_back(target, moved_[i]);
  for (size_t i = 0; i < gone_count; ++i) {
    for (const uint32_t w : triangles_[gone_[i]]) faces_.erase(w, gone_[i]);
  }
}

}  // namespace reeb
