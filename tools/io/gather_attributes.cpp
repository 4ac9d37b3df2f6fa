#include "tools/io/gather_attributes.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "tools/io/attribute_values.h"

namespace reeb::tools {
namespace {

bool alike(const Attribute& a, const Attribute& b) {
  return a.name == b.name && a.semantic == b.semantic && a.domain == b.domain && a.type == b.type &&
         a.channel_count == b.channel_count && a.names.empty() == b.names.empty();
}

/// Values of `frame` by the names of `names`, which grow.
void rename(Attribute& frame, std::vector<std::string>& names) {
  if (frame.names == names) return;
  std::vector<int32_t> now;
  for (const std::string& name : frame.names) {
    const auto at = std::find(names.begin(), names.end(), name);
    now.push_back(static_cast<int32_t>(at - names.begin()));
    if (at == names.end()) names.push_back(name);
  }
  std::vector<int32_t> values(frame.values.size() / sizeof(int32_t));
  std::memcpy(values.data(), frame.values.data(), frame.values.size());
  for (int32_t& v : values) {
    if (v >= 0 && static_cast<size_t>(v) < now.size()) v = now[static_cast<size_t>(v)];
  }
  frame.assign(std::span<const int32_t>(values));
}

}  // namespace

std::string attribute_difference(const std::vector<Attribute>& shot,
                                 const std::vector<Attribute>& frame) {
  const auto first_without = [](const std::vector<Attribute>& all,
                                const std::vector<Attribute>& others) -> const Attribute* {
    for (const Attribute& a : all) {
      const auto like = [&](const Attribute& b) { return alike(a, b); };
      if (std::none_of(others.begin(), others.end(), like)) return &a;
    }
    return nullptr;
  };
  if (const Attribute* a = first_without(frame, shot))
    return "attribute \"" + a->name + "\" begins";
  if (const Attribute* a = first_without(shot, frame)) return "attribute \"" + a->name + "\" ends";
  return {};
}

void append_attributes(std::vector<Attribute> frame, uint32_t frame_count,
                       std::vector<Attribute>& shot) {
  if (frame_count == 0) {
    shot = std::move(frame);
    return;
  }
  for (Attribute& a : shot) {
    const auto now =
        std::find_if(frame.begin(), frame.end(), [&](const Attribute& b) { return alike(a, b); });
    if (a.type == ValueType::kI32) rename(*now, a.names);
    if (!a.animated && a.values == now->values) continue;
    if (!a.animated) {
      const std::vector<uint8_t> still = a.values;
      a.values.reserve(still.size() * (size_t{frame_count} + 1));
      for (uint32_t t = 1; t < frame_count; ++t)
        a.values.insert(a.values.end(), still.begin(), still.end());
      a.animated = true;
    }
    a.values.insert(a.values.end(), now->values.begin(), now->values.end());
  }
}

std::vector<Attribute> attributes_of_frame(const std::vector<Attribute>& shot, uint32_t frame_count,
                                           uint32_t t) {
  std::vector<Attribute> out;
  for (const Attribute& a : shot) {
    Attribute& now =
        out.emplace_back(make_attribute(a.name, a.semantic, a.domain, a.type, a.channel_count));
    now.names = a.names;
    const size_t size = a.values.size() / (a.animated ? frame_count : 1);
    const auto first = a.values.begin() + static_cast<std::ptrdiff_t>(a.animated ? t * size : 0);
    now.values.assign(first, first + static_cast<std::ptrdiff_t>(size));
  }
  return out;
}

}  // namespace reeb::tools
