#include "tests/codec/attributes/samples.h"

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
  }
}

}  // namespace reeb::test
