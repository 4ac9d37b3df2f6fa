#include "codec/dec/normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace reeb {

namespace {

using Vector = std::array<double, 3>;

Vector difference(const float* a, const float* b) {
  return {double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]}, double{a[2]} - double{b[2]}};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

void vertex_normals(std::span<const uint32_t> triangles, const float* positions, size_t stride,
                    std::span<double> sums, float* normals, size_t normal_stride) {
  std::fill(sums.begin(), sums.end(), 0.0);
  for (size_t t = 0; t + 3 <= triangles.size(); t += 3) {
    const float* p = positions + triangles[t] * stride;
    const Vector area = cross(difference(positions + triangles[t + 1] * stride, p),
                              difference(positions + triangles[t + 2] * stride, p));
    for (size_t corner = 0; corner < 3; ++corner) {
      double* sum = &sums[size_t{triangles[t + corner]} * 3];
      for (size_t a = 0; a < 3; ++a) sum[a] += area[a];
    }
  }
  for (size_t v = 0; v * 3 < sums.size(); ++v) {
    const double* sum = &sums[v * 3];
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    const double scale = length > 0 && std::isfinite(length) ? 1 / length : 0;
    for (size_t a = 0; a < 3; ++a)
      normals[v * normal_stride + a] = scale > 0 ? static_cast<float>(sum[a] * scale) : 0.0f;
  }
}

}  // namespace reeb
