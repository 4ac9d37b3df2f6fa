// Numbers of attributes whatever their type, and attributes by what they mean.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

/// A static attribute without values.
inline Attribute make_attribute(std::string name, Semantic semantic, Domain domain, ValueType type,
                                uint32_t channels) {
  Attribute out;
  out.name = std::move(name);
  out.semantic = semantic;
  out.domain = domain;
  out.type = type;
  out.channel_count = channels;
  return out;
}
template <class T>
Attribute make_attribute(std::string name, Semantic semantic, Domain domain, ValueType type,
                         uint32_t channels, const std::vector<T>& values) {
  Attribute out = make_attribute(std::move(name), semantic, domain, type, channels);
  out.assign(std::span<const T>(values));
  return out;
}

/// Number i of all, of integer types as it is stored.
inline double stored_number(const Attribute& a, size_t i) {
  switch (a.type) {
    case ValueType::kBinary32:
      return double{a.get<float>(i)};
    case ValueType::kU8:
    case ValueType::kU8Normalised:
      return a.get<uint8_t>(i);
    case ValueType::kU16:
    case ValueType::kU16Normalised:
      return a.get<uint16_t>(i);
    case ValueType::kI32:
      break;
  }
  return a.get<int32_t>(i);
}

/// What one in the stored numbers is worth.
inline double unit_of(ValueType type) {
  if (type == ValueType::kU8Normalised) return 1.0 / 255;
  return type == ValueType::kU16Normalised ? 1.0 / 65535 : 1;
}

/// Number i of all, normalised ones as what they stand for.
inline float number_of(const Attribute& a, size_t i) {
  if (a.type == ValueType::kBinary32) return a.get<float>(i);
  return static_cast<float>(stored_number(a, i) * unit_of(a.type));
}

/// The first for which `wanted` is true, or nullptr.
template <typename Wanted>
const Attribute* find_attribute(std::span<const Attribute> attributes, const Wanted& wanted) {
  const auto at = std::find_if(attributes.begin(), attributes.end(), wanted);
  return at == attributes.end() ? nullptr : &*at;
}
inline const Attribute* attribute_named(std::span<const Attribute> attributes,
                                        std::string_view name) {
  return find_attribute(attributes, [&](const Attribute& a) { return a.name == name; });
}

/// Those of `attributes` that are not `written`, by name.
inline void list_unwritten(std::span<const Attribute> attributes,
                           const std::vector<const Attribute*>& written,
                           std::vector<std::string>* unkept) {
  if (unkept == nullptr) return;
  for (const Attribute& a : attributes) {
    if (std::find(written.begin(), written.end(), &a) == written.end()) unkept->push_back(a.name);
  }
}

}  // namespace reeb::tools
