#include "tools/attribute_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "tools/io/attribute_values.h"
#include "tools/text.h"

namespace reeb::tools {
namespace {

using How = AttributeRule::How;

constexpr double kMaxBits = 24;
constexpr double kDefaultAngle = 2;

/// Without a rule, where a loss is allowed. Integers are exact.
AttributeRule default_rule(const Attribute& a) {
  if (a.type != ValueType::kBinary32) return {};
  switch (a.semantic) {
    case Semantic::kNormal:
      return {.names = {}, .how = How::kCompute, .value = kDefaultAngle};
    case Semantic::kTextureCoordinate:
      return {.names = {}, .how = How::kBits, .value = 12};
    case Semantic::kTangent:
      return {.names = {}, .how = How::kBits, .value = 10};
    case Semantic::kColour:
      return {.names = {}, .how = How::kBits, .value = 8};
    case Semantic::kMaterial:
    case Semantic::kGroup:
    case Semantic::kIndex:
      return {};
    case Semantic::kGeneric:
    case Semantic::kVelocity:
      break;
  }
  return {.names = {}, .how = How::kBits, .value = 16};
}

/// What bits divide: of textures, colours and directions what their values mean, else the widest
/// range of a channel. Powers of two, so that 0, 1/2 and 1 stay what they are.
double range_of(const Attribute& a) {
  if (a.semantic == Semantic::kNormal || a.semantic == Semantic::kTangent) return 2;
  if (a.semantic == Semantic::kTextureCoordinate || a.semantic == Semantic::kColour) return 1;
  std::vector<double> low(a.channel_count, std::numeric_limits<double>::infinity());
  std::vector<double> high(a.channel_count, -std::numeric_limits<double>::infinity());
  const size_t count = a.values.size() / size_of(a.type);
  for (size_t i = 0; i < count; ++i) {
    const double x = number_of(a, i);
    if (!std::isfinite(x)) continue;
    low[i % a.channel_count] = std::min(low[i % a.channel_count], x);
    high[i % a.channel_count] = std::max(high[i % a.channel_count], x);
  }
  double widest = 0;
  for (size_t c = 0; c < low.size(); ++c) widest = std::max(widest, high[c] - low[c]);
  return widest;
}

void allow_error(double error, Attribute& a) {
  if (error > 0 && std::isfinite(error)) a.max_error.assign(a.channel_count, error);
}

void allow_bits(double bits, Attribute& a) { allow_error(range_of(a) / std::exp2(bits + 1), a); }

bool may_be_computed(const Attribute& a) {
  return a.semantic == Semantic::kNormal && a.type == ValueType::kBinary32 &&
         a.channel_count == 3 && (a.domain == Domain::kVertex || a.domain == Domain::kCorner);
}

/// Empty, or what is wrong with it.
std::string apply(const AttributeRule& rule, Attribute& a) {
  constexpr double kNormalBits = 10;
  a.max_error.clear();
  a.max_angle = 0;  // and what is turned, where it is allowed, is as near as the codec has it
  switch (rule.how) {
    case How::kBits:
      allow_bits(rule.value, a);
      break;
    case How::kError:
      allow_error(rule.value, a);
      break;
    case How::kCompute:
      if (!may_be_computed(a)) return "\"" + a.name + "\" is kept exactly, for it is no normal";
      a.max_angle = rule.value;
      allow_bits(kNormalBits, a);
      break;
    case How::kExact:
    case How::kDrop:
      break;
  }
  return {};
}

}  // namespace

bool fits_pattern(const std::string& name, const std::string& pattern) {
  size_t n = 0, p = 0;
  size_t star = std::string::npos, retry = 0;  // the last star, and where it may end
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      retry = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != std::string::npos) {
      p = star + 1;
      n = ++retry;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

std::string parse_attribute_rule(const std::string& text, AttributeRule& out) {
  const std::string wrong =
      "'" + text + "' is not NAME=exact, bits:N, error:E, compute, compute:DEGREES or drop";
  const size_t equals = text.rfind('=');
  if (equals == text.npos || equals == 0) return wrong;
  out = {.names = text.substr(0, equals)};
  const std::string how = text.substr(equals + 1);
  const std::string word = how.substr(0, how.find(':'));
  const bool has_value = word.size() < how.size();
  if (has_value && !CLI::detail::lexical_cast(how.substr(word.size() + 1), out.value)) return wrong;
  if (has_value && !(out.value > 0 && std::isfinite(out.value))) return wrong;
  static const std::map<std::string, How> kWords{{"exact", How::kExact},
                                                 {"bits", How::kBits},
                                                 {"error", How::kError},
                                                 {"compute", How::kCompute},
                                                 {"drop", How::kDrop}};
  const auto at = kWords.find(word);
  if (at == kWords.end()) return wrong;
  out.how = at->second;
  const bool wants_value = out.how == How::kBits || out.how == How::kError;
  const bool takes_value = wants_value || out.how == How::kCompute;
  if ((has_value && !takes_value) || (!has_value && wants_value)) return wrong;
  if (out.how == How::kCompute && !has_value) out.value = kDefaultAngle;
  if (out.how == How::kCompute && out.value > 180) return wrong;
  if (out.how == How::kBits && (out.value > kMaxBits || out.value != std::floor(out.value)))
    return "'" + text + "': bits are a whole number from 1 to 24";
  return {};
}

void add_attribute_option(CLI::App& command, std::vector<AttributeRule>& rules) {
  command
      .add_option_function<std::vector<std::string>>(
          "--attribute",
          [&rules](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const std::string bad = parse_attribute_rule(text, rules.emplace_back());
              if (!bad.empty()) throw CLI::ValidationError("--attribute", bad);
            }
          },
          "What is kept of an attribute, or of those that a pattern like 'v*' names; may be given "
          "several times, the last that fits counts. exact; bits:N, 1 to 24, in steps of the "
          "range / 2^N (of 1 for texture coordinates and colours, of 2 for directions); error:E, "
          "the largest error, > 0; compute[:DEGREES], normals from positions where "
          "none is further off, by default 2, else bits:10; drop. Default exact with --lossless "
          "and for whole numbers, else bits:12 for texture coordinates, compute for normals, "
          "bits:10 for tangents, bits:8 for colours, bits:16 for others")
      ->allow_extra_args(false)
      ->type_name("NAME=HOW")
      ->group("Attributes");
}

std::vector<std::string> apply_attribute_rules(const std::vector<AttributeRule>& rules,
                                               bool lossless, Sequence& sequence) {
  std::set<const AttributeRule*> used;
  std::set<std::string> notes;
  std::set<std::string> names;
  const auto rule_of = [&](const Attribute& a) {
    const AttributeRule* out = nullptr;
    for (const AttributeRule& rule : rules) {
      if (!fits_pattern(a.name, rule.names)) continue;
      out = &rule;
      used.insert(out);
    }
    return out;
  };
  for (Shot& shot : sequence.shots) {
    std::erase_if(shot.attributes, [&](const Attribute& a) {
      names.insert(a.name);
      const AttributeRule* rule = rule_of(a);
      return rule != nullptr && rule->how == How::kDrop;
    });
    for (Attribute& a : shot.attributes) {
      const AttributeRule* rule = rule_of(a);
      const AttributeRule standard = lossless ? AttributeRule() : default_rule(a);
      const std::string wrong = apply(rule != nullptr ? *rule : standard, a);
      if (!wrong.empty()) notes.insert(wrong);
    }
  }
  for (const AttributeRule& rule : rules) {
    if (used.count(&rule) > 0 || rule.names == "*") continue;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    notes.insert("--attribute: there is no \"" + rule.names + "\"" +
                 (list.empty() ? "" : ", there are " + list));
  }
  return {notes.begin(), notes.end()};
}

}  // namespace reeb::tools
