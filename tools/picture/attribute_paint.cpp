#include "tools/picture/attribute_paint.h"

#include <algorithm>
#include <cmath>

#include "tools/io/attribute_values.h"
#include "tools/picture/render.h"

namespace reeb::tools {
namespace {

/// Element of each corner.
std::vector<size_t> elements_of_corners(const Connectivity& connectivity, Domain domain) {
  std::vector<size_t> out(connectivity.corners.size());
  size_t corner = 0;
  for (size_t f = 0; f < connectivity.face_sizes.size(); ++f) {
    for (uint32_t i = 0; i < connectivity.face_sizes[f]; ++i, ++corner) {
      if (domain == Domain::kVertex) out[corner] = connectivity.corners[corner];
      if (domain == Domain::kCorner) out[corner] = corner;
      if (domain == Domain::kFace) out[corner] = f;
    }
  }
  return out;
}

bool has_own_colours(const Attribute& a) {
  return a.semantic == Semantic::kColour && a.channel_count >= 3;
}
bool is_direction(const Attribute& a) {
  return (a.semantic == Semantic::kNormal || a.semantic == Semantic::kTangent) &&
         a.channel_count >= 3;
}
bool is_category(const Attribute& a) {
  return a.channel_count == 1 && a.type != ValueType::kBinary32 &&
         (a.semantic == Semantic::kMaterial || a.semantic == Semantic::kGroup);
}

double magnitude(const Attribute& a, size_t element) {
  if (a.channel_count == 1) return number_of(a, element);
  double squared = 0;
  for (uint32_t c = 0; c < a.channel_count; ++c) {
    const double x = number_of(a, element * a.channel_count + c);
    squared += x * x;
  }
  return std::sqrt(squared);
}

// What is no number is 0.
uint8_t channel(double part) {
  return static_cast<uint8_t>(part > 0 ? std::min(part, 1.0) * 255 : 0);
}

/// Neighbours in number are far apart in colour.
Colour category_colour(int64_t value) {
  constexpr double kGolden = 0.618033988749895;
  const double hue =
      6 * (static_cast<double>(value) * kGolden - std::floor(static_cast<double>(value) * kGolden));
  Colour out{};
  for (size_t c = 0; c < 3; ++c) {
    const double distance = std::abs(std::fmod(hue + 4.0 * static_cast<double>(c), 6.0) - 3);
    out[c] = channel(0.35 + 0.55 * std::clamp(distance - 1, 0.0, 1.0));
  }
  return out;
}

Colour colour_of(const Attribute& a, size_t element, const ColourScale& scale) {
  const size_t first = element * a.channel_count;
  if (has_own_colours(a) || is_direction(a)) {
    Colour out{};
    for (size_t c = 0; c < 3; ++c) {
      const double x = number_of(a, first + c);
      out[c] = channel(is_direction(a) ? (1 + x) / 2 : x);
    }
    return out;
  }
  if (is_category(a)) return category_colour(static_cast<int64_t>(stored_number(a, first)));
  const double range = scale.high - scale.low;
  return error_colour(range > 0 ? (magnitude(a, element) - scale.low) / range : 0);
}

}  // namespace

Status find_scale(const Sequence& sequence, const std::string& attribute, ColourScale& out) {
  std::string names;
  bool found = false;
  for (const Shot& shot : sequence.shots) {
    for (const Attribute& a : shot.attributes) names += (names.empty() ? "" : ", ") + a.name;
    const Attribute* a = attribute_named(shot.attributes, attribute);
    if (a == nullptr) continue;
    found = true;
    if (has_own_colours(*a) || is_direction(*a) || is_category(*a)) continue;
    for (size_t i = 0; i * a->element_bytes() < a->values.size(); ++i) {
      const double x = magnitude(*a, i);
      if (!std::isfinite(x)) continue;
      out.low = out.used ? std::min(out.low, x) : x;
      out.high = out.used ? std::max(out.high, x) : x;
      out.used = true;
    }
  }
  if (found) return {};
  return Status::invalid("there is no attribute \"" + attribute + "\"" +
                         (names.empty() ? ", and no other" : "; there are " + names));
}

std::vector<Colour> paint_corners(const Shot& shot, uint32_t t, const std::string& attribute,
                                  const ColourScale& scale) {
  std::vector<Colour> out;
  const Attribute* a = attribute_named(shot.attributes, attribute);
  if (a == nullptr) return out;
  const size_t first = a->animated ? t * shot.element_count(a->domain) : 0;
  for (const size_t element : elements_of_corners(shot.connectivity, a->domain))
    out.push_back(colour_of(*a, first + element, scale));
  return out;
}

std::vector<float> texture_coordinates(const Shot& shot, uint32_t t) {
  std::vector<float> out;
  const Attribute* a = find_attribute(shot.attributes, [](const Attribute& b) {
    return b.semantic == Semantic::kTextureCoordinate && b.channel_count >= 2 &&
           (b.domain == Domain::kVertex || b.domain == Domain::kCorner);
  });
  if (a == nullptr) return out;
  const size_t first = a->animated ? t * shot.element_count(a->domain) : 0;
  for (const size_t element : elements_of_corners(shot.connectivity, a->domain)) {
    for (size_t c = 0; c < 2; ++c) {
      const float x = number_of(*a, (first + element) * a->channel_count + c);
      out.push_back(std::isfinite(x) ? x : 0);
    }
  }
  return out;
}

}  // namespace reeb::tools
