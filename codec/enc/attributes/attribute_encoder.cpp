#include "codec/enc/attributes/attribute_encoder.h"

#include <algorithm>
#include <utility>

#include "codec/common/attributes/attribute_syntax.h"
#include "codec/enc/attributes/integer_encoder.h"
#include "codec/enc/attributes/number_choice.h"
#include "entropy/interval_coder.h"

namespace reeb {

namespace {

/// True where two elements stand for other numbers.
bool differ(const ChosenNumbers& numbers, uint32_t a, uint32_t b) {
  const size_t channels = numbers.channels.size();
  const auto at = [&](uint32_t e) {
    return numbers.integers.begin() + static_cast<ptrdiff_t>(e * channels);
  };
  if (!std::equal(at(a), at(a) + static_cast<ptrdiff_t>(channels), at(b))) return true;
  if (numbers.exceptions.empty()) return false;
  const auto of = [&](uint32_t e) {
    return std::lower_bound(numbers.exceptions.begin(), numbers.exceptions.end(), e * channels,
                            [](const NumberException& x, size_t i) { return x.index < i; });
  };
  auto x = of(a), y = of(b);
  for (;; ++x, ++y) {
    const bool x_ends = x == numbers.exceptions.end() || x->index >= (size_t{a} + 1) * channels;
    const bool y_ends = y == numbers.exceptions.end() || y->index >= (size_t{b} + 1) * channels;
    if (x_ends || y_ends) return x_ends != y_ends;
    if (x->bits != y->bits || x->index - a * channels != y->index - b * channels) return true;
  }
}

/// From elements to sites: what the lowest element of each has.
ChosenNumbers gather(const ChosenNumbers& numbers, const Sites& sites) {
  if (sites.of_element.empty()) return numbers;
  const size_t channels = numbers.channels.size();
  ChosenNumbers out;
  out.channels = numbers.channels;
  auto exception = numbers.exceptions.begin();
  for (size_t e = 0; e < sites.of_element.size(); ++e) {
    const size_t first = out.integers.size();
    const bool opens = sites.of_element[e] * channels == first;
    const auto at = numbers.integers.begin() + static_cast<ptrdiff_t>(e * channels);
    if (opens) out.integers.insert(out.integers.end(), at, at + static_cast<ptrdiff_t>(channels));
    for (; exception != numbers.exceptions.end() && exception->index < (e + 1) * channels;
         ++exception) {
      if (opens)
        out.exceptions.push_back({first + exception->index - e * channels, exception->bits});
    }
  }
  return out;
}

}  // namespace

AttributeHeader header_of(const Attribute& a) {
  AttributeHeader h;
  h.name = a.name;
  h.semantic = a.semantic;
  h.domain = a.domain;
  h.type = a.type;
  h.channel_count = a.channel_count;
  h.flags = a.animated ? AttributeHeader::kAnimated : 0;
  return h;
}

Status encode_static_attribute(const Attribute& attribute, const ShotSurface& surface,
                               CodedAttribute& out) {
  out = {};
  out.header = header_of(attribute);
  for (const std::string& name : attribute.names) out.body.names.push_back({name});
  const ChosenNumbers chosen = choose_numbers(attribute);
  out.body.channels = chosen.channels;
  IntervalEncoder coder;
  Sites sites;
  if (!is_category(out.header, out.body)) {
    sites = code_sites(coder, attribute.domain, surface,
                       [&](uint32_t a, uint32_t b) { return differ(chosen, a, b); });
  }
  ChosenNumbers numbers = gather(chosen, sites);
  if (Status s =
          encode_integers(out.header, out.body, surface, sites.mesh, numbers.integers, coder);
      !s.ok())
    return s;
  if (attribute.type == ValueType::kBinary32) {
    if (Status s = code_exceptions(coder, numbers.integers.size(), numbers.exceptions); !s.ok())
      return s;
  }
  out.section = coder.finish();
  return {};
}

}  // namespace reeb
