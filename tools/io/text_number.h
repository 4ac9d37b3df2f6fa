// Numbers as text formats spell them.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace reeb::tools {

/// A number of a file, as a Sequence keeps it.
struct Real {
  float value = 0;      ///< the binary32 value nearest to what the file says
  float remainder = 0;  ///< what the file says less `value`; of a decimal only where it is more
                        ///< than half a unit of its last digit, for a decimal that short is a
                        ///< rounding itself
};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_blank(char c) { return c == ' ' || c == '\t'; }
inline bool is_line_end(char c) { return c == '\n' || c == '\r'; }
/// What may follow a number; the backslash continues a line.
inline bool ends_number(char c) { return is_blank(c) || is_line_end(c) || c == '\\'; }

namespace detail {

inline constexpr std::array<double, 16> kPowersOfTen{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// `value` with what `exact`, a decimal whose last digit has the unit `unit`, says beyond it.
inline Real remembered(double exact, float value, double unit) {
  const double remainder = exact - double{value};
  // `exact` is rounded as well, to binary64.
  const bool said = std::abs(remainder) > 0.500001 * unit + 0x1p-52 * std::abs(exact);
  return {value, said ? static_cast<float>(remainder) : 0.0f};
}

/// True where rounding to binary32 by way of the binary64 value `x` may go wrong: half-way between
/// two values the digits that `x` has lost would decide.
inline bool is_halfway(double x) { return (std::bit_cast<uint64_t>(x) & 0x1fffffff) == 0x10000000; }

/// Any number that begins at `at`: with more digits, with an exponent, inf and nan.
const char* read_any_real(const char* at, const char* end, Real& out);

}  // namespace detail

/// Reads the number that begins at `at` and returns where it ends; null where there is none.
/// Exponents may be written with a D, as Fortran does. What lies beyond binary32 is infinite.
inline const char* read_real(const char* at, const char* end, Real& out) {
  const char* p = at;
  if (p != end && (*p == '-' || *p == '+')) ++p;
  const char* const first = p;
  uint64_t digits = 0;
  const auto take_digits = [&] {
    for (; p != end && is_digit(*p); ++p) digits = 10 * digits + static_cast<uint64_t>(*p - '0');
  };
  take_digits();
  const char* last_whole = p;  // past the digits before the point
  size_t decimals = 0;
  if (p != end && *p == '.') {
    ++p;
    take_digits();
    decimals = static_cast<size_t>(p - last_whole - 1);
  }
  // Up to 15 digits without exponent, as nearly all numbers are: both parts of the quotient are
  // exact in binary64, so it is the binary64 value nearest to the text.
  const bool any_digit = last_whole != first || decimals != 0;
  const bool simple = any_digit && p - first <= 15 && (p == end || ends_number(*p));
  const double magnitude =
      simple ? static_cast<double>(digits) / detail::kPowersOfTen[decimals] : 0.0;
  if (!simple || detail::is_halfway(magnitude)) return detail::read_any_real(at, end, out);
  const double exact = *at == '-' ? -magnitude : magnitude;
  out = detail::remembered(exact, static_cast<float>(exact), 1 / detail::kPowersOfTen[decimals]);
  return p;
}

}  // namespace reeb::tools
