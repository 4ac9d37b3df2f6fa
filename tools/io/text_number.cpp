#include "tools/io/text_number.h"

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>

namespace reeb::tools::detail {
namespace {

/// [-] digits [. digits] [e [+-] digits]
struct Decimal {
  std::string_view digits;  ///< with the point
  int exponent = 0;         ///< within +- 1,000,000
};

Decimal split(std::string_view number) {
  if (number.starts_with('-')) number.remove_prefix(1);
  const size_t letter = std::min(number.find_first_of("eE"), number.size());
  Decimal out{number.substr(0, letter)};
  if (letter == number.size()) return out;
  std::string_view exponent = number.substr(letter + 1);
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  const auto result =
      std::from_chars(exponent.data(), exponent.data() + exponent.size(), out.exponent);
  if (result.ec != std::errc()) out.exponent = exponent.starts_with('-') ? INT32_MIN : INT32_MAX;
  out.exponent = std::clamp(out.exponent, -1000000, 1000000);
  return out;
}

size_t point(const Decimal& decimal) {
  return std::min(decimal.digits.find('.'), decimal.digits.size());
}

/// The unit of the last digit.
double unit(const Decimal& decimal) {
  const size_t behind = decimal.digits.size() - point(decimal);
  return std::pow(10.0, decimal.exponent - (behind == 0 ? 0.0 : static_cast<double>(behind - 1)));
}

/// Below 1, from where its first digit other than 0 stands.
bool is_small(const Decimal& decimal) {
  const size_t leading = std::min(decimal.digits.find_first_not_of("0."), decimal.digits.size());
  return static_cast<double>(point(decimal)) - static_cast<double>(leading) + decimal.exponent <= 0;
}

/// `number` is spelled right. What is too small for `Float` is zero, too large infinite.
template <typename Float>
Float parse(std::string_view number) {
  Float value = 0;
  const auto result = std::from_chars(number.data(), number.data() + number.size(), value);
  if (result.ec != std::errc::result_out_of_range) return value;
  const Float magnitude =
      is_small(split(number)) ? Float(0) : std::numeric_limits<Float>::infinity();
  return number.starts_with('-') ? -magnitude : magnitude;
}

bool is_number(std::string_view text) {
  double ignored = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), ignored);
  return result.ec != std::errc::invalid_argument && result.ptr == text.data() + text.size();
}

}  // namespace

const char* read_any_real(const char* at, const char* end, Real& out) {
  const char* const stop = std::find_if(at, end, ends_number);
  std::string_view number(at, static_cast<size_t>(stop - at));
  if (number.starts_with('+') && !number.starts_with("+-")) number.remove_prefix(1);
  std::string fortran;
  if (const size_t letter = number.find_first_of("dD"); letter != number.npos) {
    fortran = number;
    fortran[letter] = 'e';
    number = fortran;
  }
  if (!is_number(number)) return nullptr;
  const auto exact = parse<double>(number);
  const bool direct = is_halfway(exact) || !(std::abs(exact) >= FLT_MIN);
  const float value = direct ? parse<float>(number) : static_cast<float>(exact);
  out = remembered(exact, value, unit(split(number)));
  return stop;
}

}  // namespace reeb::tools::detail
