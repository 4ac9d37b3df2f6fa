#include "tests/codec/attributes/samples.h"

#include <cmath>

namespace reeb::test {

void add_all(Shot& shot, std::mt19937& random) {
  for (const Domain domain : {Domain::kVertex, Domain::kCorner, Domain::kFace, Domain::kShot}) {
    const size_t n = shot.element_count(domain);
    const std::string d = std::to_string(static_cast<int>(domain));
    auto& out = shot.attributes;
    const auto add = [&]<class T>(const std::string& name, ValueType type, uint32_t channels,
                                  const std::vector<T>& values) {
      out.push_back(make(name + d, domain, type, channels, values));
    };
    add("f", ValueType::kBinary32, 2, some<float>(2 * n, random, -1, 1, 1e-3));
    add("raw", ValueType::kBinary32, 1, some<float>(n, random, -9, 9, 0.7e-7));
    add("u8", ValueType::kU8, 3, some<uint8_t>(3 * n, random, 0, 255, 5));
    add("n8", ValueType::kU8Normalised, 4, some<uint8_t>(4 * n, random, 0, 255, 1));
    add("u16", ValueType::kU16, 1, some<uint16_t>(n, random, 0, 65535, 1));
    add("n16", ValueType::kU16Normalised, 1, some<uint16_t>(n, random, 0, 65535, 9));
    add("i32", ValueType::kI32, 1, some<int32_t>(n, random, -2e9, 2e9, 1001));
    add("group", ValueType::kU16, 1, some<uint16_t>(n, random, 0, 7, 1));
    out.back().semantic = Semantic::kGroup;
    out.back().names = {"left", "right \xC3\xA9", ""};
    add("uv", ValueType::kBinary32, 2, some<float>(2 * n, random, 0, 1, 1.0 / 64));
    out.back().semantic = Semantic::kTextureCoordinate;
    add("place", ValueType::kI32, 1, some<int32_t>(n, random, -1, static_cast<double>(n), 1));
    out.back().semantic = Semantic::kIndex;
  }
}

void add_turned_normals(Shot& shot) {
  const auto& corners = shot.connectivity.corners;
  std::vector<float> still, moving;
  const auto add = [](std::vector<float>& to, double i, double t) {
    const double turn = 2.4 * i + 0.3 * t, height = std::cos(1.7 * i + 0.2 * t);
    const double across = std::sqrt(1 - height * height);
    for (const double x : {across * std::cos(turn), across * std::sin(turn), height})
      to.push_back(static_cast<float>(x));
  };
  for (uint32_t v = 0; v < shot.connectivity.vertex_count; ++v) add(still, v, 0);
  for (uint32_t t = 0; t < shot.frame_count; ++t) {
    for (const uint32_t v : corners) add(moving, v, t);
  }
  Attribute a = make("still", Domain::kVertex, ValueType::kBinary32, 3, still);
  a.semantic = Semantic::kNormal;
  a.max_angle = 2;
  a.corrected_angle = 1;
  shot.attributes.push_back(a);
  a.name = "turning";
  a.domain = Domain::kCorner;
  a.animated = true;
  a.assign(std::span<const float>(moving));
  shot.attributes.push_back(a);
}

}  // namespace reeb::test
