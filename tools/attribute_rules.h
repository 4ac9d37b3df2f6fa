// How precisely attributes are kept, as the user says it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "codec/common/base/sequence.h"

namespace reeb::tools {

/// One --attribute NAME=HOW.
struct AttributeRule {
  enum class How { kExact, kBits, kError, kCompute, kDrop };
  std::string names;  ///< a pattern: * any characters, ? one
  How how = How::kExact;
  double value = 0;  ///< bits, error, or degrees
};

/// Empty where `text` is good, what is wrong otherwise.
std::string parse_attribute_rule(const std::string& text, AttributeRule& out);

/// --attribute.
void add_attribute_option(CLI::App& command, std::vector<AttributeRule>& rules);

/// True where `name` fits the pattern.
bool fits_pattern(const std::string& name, const std::string& pattern);

/// Sets what may be lost of each attribute, by the last rule that fits its name, else by default;
/// drops those that are to be. `lossless`: the default is exact. Gives what is to be said, e.g. a
/// rule that fits nothing.
std::vector<std::string> apply_attribute_rules(const std::vector<AttributeRule>& rules,
                                               bool lossless, Sequence& sequence);

}  // namespace reeb::tools
