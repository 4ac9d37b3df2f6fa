// Attributes for tests.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::test {

template <class T>
Attribute make(const std::string& name, Domain domain, ValueType type, uint32_t channels,
               const std::vector<T>& values) {
  Attribute a;
  a.name = name;
  a.domain = domain;
  a.type = type;
  a.channel_count = channels;
  a.assign(std::span<const T>(values));
  return a;
}

/// Random numbers, some the same as others.
template <class T>
std::vector<T> some(size_t count, std::mt19937& random, double low, double high, double step) {
  std::vector<T> out(count);
  std::uniform_int_distribution<int> pick(0, static_cast<int>((high - low) / step));
  for (size_t i = 0; i < count; ++i)
    out[i] = i % 3 == 1 ? out[i - 1] : static_cast<T>(low + step * pick(random));
  return out;
}

/// A static attribute of every domain and type.
void add_all(Shot& shot, std::mt19937& random);

/// Normals that point anywhere: static ones at vertices, animated ones at corners, to 1 degree.
void add_turned_normals(Shot& shot);

}  // namespace reeb::test
