#include "tools/attribute_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>

#include "codec/enc/reference/face_matching.h"
#include "tools/attribute_text.h"
#include "tools/io/attribute_values.h"

namespace reeb::tools {
namespace {

/// Elements of the original that those of the other are, of each domain.
class Matching {
 public:
  Matching(const Shot& original, const Shot& other) {
    const Connectivity& to = original.connectivity;
    const Connectivity& from = other.connectivity;
    faces_.resize(from.face_sizes.size());
    corners_.resize(from.corners.size());
    std::iota(faces_.begin(), faces_.end(), 0u);
    std::iota(corners_.begin(), corners_.end(), 0u);
    if (to == from) return;
    const FaceOrder order = match_faces(from, to);
    std::vector<uint32_t> first{0};
    for (const uint32_t size : to.face_sizes) first.push_back(first.back() + size);
    size_t corner = 0;
    for (size_t f = 0; f < faces_.size(); ++f) {
      faces_[f] = order.index[f];
      const uint32_t size = from.face_sizes[f];
      for (uint32_t i = 0; i < size; ++i)
        corners_[corner++] = first[faces_[f]] + (i + size - order.first[f]) % size;
    }
  }

  size_t operator()(Domain domain, size_t element) const {
    if (domain == Domain::kFace) return faces_[element];
    return domain == Domain::kCorner ? corners_[element] : element;
  }

 private:
  std::vector<uint32_t> faces_, corners_;
};

/// The frames of one shot of each side that go together.
struct Stretch {
  const Shot* original = nullptr;
  const Shot* other = nullptr;
  uint32_t first = 0, first_original = 0, first_other = 0;  ///< frames, in all and in the shots
  uint32_t count = 0;
};

std::vector<Stretch> stretches(const Sequence& a, const Sequence& b) {
  std::vector<Stretch> out;
  size_t i = 0, j = 0;
  uint32_t t = 0, s = 0, u = 0;
  while (i < a.shots.size() && j < b.shots.size()) {
    const uint32_t left_a = a.shots[i].frame_count - s, left_b = b.shots[j].frame_count - u;
    const uint32_t count = std::min(left_a, left_b);
    if (count > 0) out.push_back({&a.shots[i], &b.shots[j], t, s, u, count});
    t += count;
    s = left_a == count ? 0 : s + count;
    u = left_b == count ? 0 : u + count;
    i += left_a == count ? 1 : 0;
    j += left_b == count ? 1 : 0;
  }
  return out;
}

bool is_whole(const Attribute& a) {
  return a.type == ValueType::kU8 || a.type == ValueType::kU16 || a.type == ValueType::kI32;
}

double angle_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double cross =
      std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::atan2(cross, dot) * 180 / std::numbers::pi;
}

/// One attribute on both sides, in the frames of a stretch.
class Pair {
 public:
  Pair(const Attribute& a, const Attribute& b, const Stretch& stretch, const Matching& matching,
       AttributeComparison& out)
      : a_(a), b_(b), stretch_(stretch), matching_(matching), out_(out) {}

  void run() {
    out_.whole = out_.whole && is_whole(a_) && is_whole(b_);
    out_.max_error.resize(std::max<size_t>(out_.max_error.size(), a_.channel_count));
    const uint32_t count = a_.animated || b_.animated ? stretch_.count : 1;
    for (uint32_t t = 0; t < count; ++t) compare_frame(t);
  }

 private:
  void compare_frame(uint32_t t) {
    const size_t elements = stretch_.other->element_count(b_.domain);
    const size_t first_a = a_.animated ? (stretch_.first_original + t) * elements : 0;
    const size_t first_b = b_.animated ? (stretch_.first_other + t) * elements : 0;
    for (size_t e = 0; e < elements; ++e)
      compare_element(first_a + matching_(b_.domain, e), first_b + e, stretch_.first + t);
  }

  void compare_element(size_t i, size_t j, uint32_t frame) {
    ++out_.compared;
    if (same_value(i, j)) return;
    out_.identical = false;
    ++out_.different;
    if (out_.whole) return;
    double worst = 0;  // of this element
    std::array<double, 3> x{}, y{};
    for (uint32_t c = 0; c < a_.channel_count; ++c) {
      const double from = number_of(a_, i * a_.channel_count + c);
      const double to = number_of(b_, j * b_.channel_count + c);
      const double error = std::abs(from - to);
      worst = std::max(worst, std::isnan(error) ? INFINITY : error);
      out_.max_error[c] = std::max(out_.max_error[c], std::isnan(error) ? INFINITY : error);
      if (c < 3) {
        x[c] = from;
        y[c] = to;
      }
    }
    if (out_.semantic == Semantic::kNormal && a_.channel_count == 3) worst = angle_between(x, y);
    if (worst <= out_.worst) return;
    out_.worst = worst;
    out_.worst_frame = frame;
  }

  // Names count, not the places that they have in the tables.
  bool same_value(size_t i, size_t j) const {
    for (uint32_t c = 0; c < a_.channel_count; ++c) {
      const size_t at_a = i * a_.channel_count + c, at_b = j * b_.channel_count + c;
      if (!a_.names.empty() || !b_.names.empty()) {
        if (name_at(a_, at_a) != name_at(b_, at_b)) return false;
      } else if (a_.type == b_.type) {
        const size_t size = size_of(a_.type);
        if (std::memcmp(&a_.values[at_a * size], &b_.values[at_b * size], size) != 0) return false;
      } else if (number_of(a_, at_a) != number_of(b_, at_b)) {
        return false;
      }
    }
    return true;
  }

  static std::string name_at(const Attribute& a, size_t i) {
    const double value = stored_number(a, i);
    if (value >= 0 && value < static_cast<double>(a.names.size()))
      return a.names[static_cast<size_t>(value)];
    return value < 0 ? std::string() : std::to_string(static_cast<int64_t>(value));
  }

  const Attribute& a_;
  const Attribute& b_;
  const Stretch& stretch_;
  const Matching& matching_;
  AttributeComparison& out_;
};

AttributeComparison& entry(const Attribute& a, std::vector<AttributeComparison>& all) {
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const AttributeComparison& c) { return c.name == a.name; });
  if (at != all.end()) return *at;
  AttributeComparison& out = all.emplace_back();
  out.name = a.name;
  out.semantic = a.semantic;
  return out;
}

/// The order of a list, which files tell only where they keep it.
bool is_order(const Attribute& a) { return a.name == "vt.index" || a.name == "vn.index"; }

void compare_stretch(const Stretch& stretch, std::vector<AttributeComparison>& out) {
  const Matching matching(*stretch.original, *stretch.other);
  for (const Attribute& a : stretch.original->attributes) {
    const Attribute* b = attribute_named(stretch.other->attributes, a.name);
    if (b == nullptr && is_order(a)) continue;
    AttributeComparison& c = entry(a, out);
    if (b == nullptr)
      c.problem = "only in the original";
    else if (b->domain != a.domain)
      c.problem = "of each " + to_string(a.domain) + " against each " + to_string(b->domain);
    else if (b->channel_count != a.channel_count)
      c.problem = std::to_string(a.channel_count) + " against " + std::to_string(b->channel_count) +
                  " channels";
    else
      Pair(a, *b, stretch, matching, c).run();
  }
  for (const Attribute& b : stretch.other->attributes) {
    if (attribute_named(stretch.original->attributes, b.name) == nullptr && !is_order(b))
      entry(b, out).problem = "not in the original";
  }
}

}  // namespace

double AttributeComparison::figure() const {
  if (!problem.empty()) return INFINITY;
  return whole ? static_cast<double>(different) : worst;
}

std::vector<AttributeComparison> compare_attributes(const Sequence& original,
                                                    const Sequence& other) {
  std::vector<AttributeComparison> out;
  for (const Stretch& stretch : stretches(original, other)) compare_stretch(stretch, out);
  for (AttributeComparison& c : out) c.identical = c.identical && c.problem.empty();
  return out;
}

}  // namespace reeb::tools
