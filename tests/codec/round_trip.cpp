#include "tests/codec/round_trip.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "tests/codec/shapes.h"

namespace reeb::test {

EncodeOptions quick_options() {
  EncodeOptions options;
  options.target = Target::kKg;
  options.target_value = 0.2;
  options.threads = 1;
  options.regions = 0;
  return options;
}

Encoded encode_or_fail(const Sequence& sequence, const EncodeOptions& options) {
  Encoded out;
  const Status status = encode(sequence, options, out.bytes, out.stats);
  INFO(status.message());
  REQUIRE(status.ok());
  return out;
}

Sequence decode_or_fail(const Bytes& bytes, unsigned threads) {
  DecodeOptions options;
  options.threads = threads;
  Sequence out;
  const Status status = decode_sequence(bytes, options, out);
  INFO(status.message());
  REQUIRE(status.ok());
  return out;
}

Errors measure(const Sequence& original, const Sequence& decoded) {
  double squared = 0, energy = 0, largest = 0;
  REQUIRE(decoded.shots.size() == original.shots.size());
  for (size_t i = 0; i < original.shots.size(); ++i) {
    const Shot& shot = original.shots[i];
    REQUIRE(decoded.shots[i].positions.size() == shot.positions.size());
    for (uint32_t t = 0; t < shot.frame_count; ++t) {
      const auto a = shot.frame(t), b = decoded.shots[i].frame(t);
      double mean[3] = {0, 0, 0};
      const double count = shot.connectivity.vertex_count;
      for (size_t j = 0; j < a.size(); ++j) mean[j % 3] += static_cast<double>(a[j]) / count;
      for (size_t v = 0; v < a.size(); v += 3) {
        double square = 0;
        for (size_t j = v; j < v + 3; ++j) {
          const double d = static_cast<double>(a[j]) - static_cast<double>(b[j]);
          square += d * d;
          largest = std::max(largest, std::abs(d));
          energy += std::pow(static_cast<double>(a[j]) - mean[j % 3], 2);
        }
        squared += square;
      }
    }
  }
  const double kg = energy > 0 ? 100 * std::sqrt(squared / energy) : 0;
  return {kg, std::sqrt(squared / vertex_frames(original)), largest};
}

double vertex_frames(const Sequence& sequence) {
  double sum = 0;
  for (const Shot& s : sequence.shots)
    sum += static_cast<double>(s.connectivity.vertex_count) * s.frame_count;
  return sum;
}

std::multiset<std::vector<uint32_t>> face_set(const Connectivity& connectivity) {
  std::multiset<std::vector<uint32_t>> out;
  const uint32_t* corner = connectivity.corners.data();
  for (const uint32_t size : connectivity.face_sizes) {
    std::vector<uint32_t> turned(corner, corner + size), best = turned;
    corner += size;
    for (uint32_t i = 1; i < size; ++i) {
      std::rotate(turned.begin(), turned.begin() + 1, turned.end());
      best = std::min(best, turned);
    }
    out.insert(best);
  }
  return out;
}

bool same_positions(const Sequence& a, const Sequence& b) {
  if (a.shots.size() != b.shots.size()) return false;
  for (size_t i = 0; i < a.shots.size(); ++i) {
    const std::vector<float>&p = a.shots[i].positions, &q = b.shots[i].positions;
    if (p.size() != q.size()) return false;
    if (std::memcmp(p.data(), q.data(), p.size() * sizeof(float)) != 0) return false;
  }
  return true;
}

Sequence large_sequence() { return sequence_of({animate(torus(63, 32), 40)}); }

}  // namespace reeb::test
