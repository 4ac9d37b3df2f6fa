#include "codec/common/fast/plain_positions.h"

#include <cstring>

#include "codec/common/fast/magnitude_vectors_impl.h"

namespace reeb {

namespace {

using Point = PlainPositions::Point;
using Whole = int32_t __attribute__((vector_size(16)));
using Reals = float __attribute__((vector_size(16)));

Whole load(const Point& from) {
  Whole out;
  std::memcpy(&out, &from, sizeof out);
  return out;
}

Point stored(const Whole& from) {
  Point out;
  std::memcpy(&out, &from, sizeof out);
  return out;
}

constexpr std::array<float, 2 * MeshWalk::kMaxKnown + 1> make_shares() {
  std::array<float, 2 * MeshWalk::kMaxKnown + 1> out{};
  for (uint32_t i = 1; i < out.size(); ++i) out[i] = 1.0f / static_cast<float>(i);
  return out;
}
constexpr auto kShares = make_shares();  ///< 1 / i

/// sum / count, rounded to the nearest.
Whole mean(const Whole& sum, uint32_t count) {
  constexpr float kRound = 12582912.0f;  // 3 * 2^22: leaves no fraction
  const Reals real = __builtin_convertvector(sum, Reals) * kShares[count];
  return __builtin_convertvector((real + kRound) - kRound, Whole);
}

PlainPositions::Guess make_guess(const Whole& place, const Whole& expected) {
  return {stored(place), stored(magnitude_class(expected))};
}

}  // namespace

PlainPositions::Guess PlainPositions::guess(uint32_t turn) const {
  const auto triangles = walk_.triangles(turn);
  Whole edges{}, tips{}, around{};
  Whole least = Whole{} + INT32_MAX, most = Whole{} + INT32_MIN;
  uint32_t count = 0;
  for (const auto& [a, b, across] : triangles) {
    around += load(magnitudes_[a]) + load(magnitudes_[b]);
    const Whole edge = load(points_[a]) + load(points_[b]);
    edges += edge;
    if (across == kNoTurn) continue;
    const Whole tip = edge - load(points_[across]);
    tips += tip;
    least = tip < least ? tip : least;
    most = tip > most ? tip : most;
    ++count;
  }
  const auto ends = 2 * static_cast<uint32_t>(triangles.size());
  const Whole recent = load(running_) >> 4;
  const Whole near = ends == 0 ? recent : mean_magnitude(around, ends);
  const Whole usual = expected_magnitude(near, recent);
  if (count > 1) return make_guess(mean(tips, count), (5 * usual + 32 * (most - least)) >> 3);
  if (count == 1) return make_guess(tips, (5 * usual) >> 2);
  if (ends > 0) return make_guess(mean(edges, ends), 2 * usual);
  return make_guess(turn > 0 ? load(points_[turn - 1]) : Whole{}, 2 * usual);
}

void PlainPositions::note(uint32_t turn, const Point& position, const Point& difference) {
  points_[turn] = position;
  const Whole magnitude = noted_magnitude(load(difference));
  magnitudes_[turn] = stored(magnitude);
  running_ = stored(decayed(load(running_), magnitude));
}

}  // namespace reeb
