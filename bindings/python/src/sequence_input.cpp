#include "bindings/python/src/sequence_input.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>
#include <vector>

#include "bindings/python/src/errors.h"
#include "reeb.h"
#include "tools/attribute_rules.h"

namespace reeb_python {
namespace {

/// Sets what may be lost, by the command's rules.
void apply_rule(const std::string& keep, bool lossless, reeb::Attribute& attribute) {
  std::vector<reeb::tools::AttributeRule> rules;
  if (!keep.empty()) {
    const std::string wrong = reeb::tools::parse_attribute_rule("*=" + keep, rules.emplace_back());
    if (!wrong.empty())
      throw Failure{REEB_INVALID_ARGUMENT, "attributes[" + attribute.name + "]: keep: " + wrong};
  }
  reeb::Sequence alone;
  alone.shots.emplace_back().attributes.push_back(std::move(attribute));
  const std::vector<std::string> notes = reeb::tools::apply_attribute_rules(rules, lossless, alone);
  if (!notes.empty()) throw Failure{REEB_INVALID_ARGUMENT, "attributes: " + notes[0]};
  attribute = std::move(alone.shots[0].attributes.at(0));
}

}  // namespace

reeb::Connectivity connectivity_of(size_t vertices, const Indices& sizes, const Indices& corners) {
  return {static_cast<uint32_t>(vertices),
          {sizes.data(), sizes.data() + sizes.size()},
          {corners.data(), corners.data() + corners.size()}};
}

reeb::Attribute attribute_of(const nb::dict& from, bool lossless) {
  const auto number = [&](const char* key) { return nb::cast<uint32_t>(from[key]); };
  reeb::Attribute out;
  out.name = nb::cast<std::string>(from["name"]);
  out.semantic = static_cast<reeb::Semantic>(number("semantic"));
  out.domain = static_cast<reeb::Domain>(number("domain"));
  out.type = static_cast<reeb::ValueType>(number("type"));
  out.channel_count = number("channels");
  out.animated = nb::cast<bool>(from["animated"]);
  out.names = nb::cast<std::vector<std::string>>(from["names"]);
  const auto values = nb::cast<nb::bytes>(from["values"]);
  const auto* const first = reinterpret_cast<const uint8_t*>(values.c_str());
  out.values.assign(first, first + values.size());
  apply_rule(nb::cast<std::string>(from["keep"]), lossless, out);
  return out;
}

}  // namespace reeb_python
