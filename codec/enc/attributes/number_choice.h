// Finds integers for the numbers of an attribute.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/common/attributes/attribute_syntax.h"

namespace reeb {

/// The integers of an attribute's values at one time, and what they stand for.
struct ChosenNumbers {
  std::vector<ChannelHeader> channels;
  std::vector<uint32_t> integers;           ///< [element][channel]
  std::vector<NumberException> exceptions;  ///< of `integers`
};

/// Largest error of a channel, in its numbers: of an integer type n + 0.49, n whole; 0: none.
double channel_error(const Attribute& attribute, uint32_t channel);

/// Exact, or within the errors that the attribute allows.
ChosenNumbers choose_numbers(const Attribute& attribute);

}  // namespace reeb
