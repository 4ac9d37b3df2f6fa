// What mutated sources call: every operator and constant of a site in a function of its own that
// does as the source says, but for the one mutant that is chosen. sites.py puts the calls in; the
// build gives this header to every file (-include).
#pragma once

#include <type_traits>
#include <utility>

namespace mutants {

extern int chosen;                   ///< number of the mutant that is on; -1: none
extern unsigned char hits[1 << 16];  ///< sites that ran

constexpr bool is_on(int site) {
  if (std::is_constant_evaluated()) return false;
  hits[site] = 1;
  return chosen == site;
}

/// A number beside a vector of the compiler's, which takes it if it is of the vector's kind.
template <class Other, class T>
constexpr decltype(auto) beside(const T& value) {
  if constexpr (std::is_arithmetic_v<T> && requires(Other o) { o *o, o[0]; }) {
    return static_cast<std::remove_cvref_t<decltype(std::declval<Other>()[0])>>(value);
  } else {
    return (value);
  }
}

/// A site whose mutant does `changed` where both compile and give one type.
#define MUTANT_BINARY(name, kept, changed)                                       \
  template <class A, class B>                                                    \
  constexpr auto name(int site, const A& left, const B& right) {                 \
    const auto& a = beside<B>(left);                                             \
    const auto& b = beside<A>(right);                                            \
    if constexpr (requires { a changed b; }) {                                   \
      if constexpr (std::is_same_v<decltype(a kept b), decltype(a changed b)>) { \
        if (is_on(site)) return a changed b;                                     \
      }                                                                          \
    }                                                                            \
    return a kept b;                                                             \
  }
MUTANT_BINARY(add, +, -)
MUTANT_BINARY(subtract, -, +)
MUTANT_BINARY(multiply, *, +)
MUTANT_BINARY(divide, /, *)
MUTANT_BINARY(remainder, %, +)
MUTANT_BINARY(shift_left, <<, >>)
MUTANT_BINARY(shift_right, >>, <<)
MUTANT_BINARY(bit_and, &, |)
MUTANT_BINARY(bit_or, |, &)
MUTANT_BINARY(bit_xor, ^, |)
MUTANT_BINARY(less, <, <=)
MUTANT_BINARY(less_equal, <=, <)
MUTANT_BINARY(greater, >, >=)
MUTANT_BINARY(greater_equal, >=, >)
MUTANT_BINARY(equal, ==, !=)
MUTANT_BINARY(not_equal, !=, ==)
#undef MUTANT_BINARY

#define MUTANT_ASSIGN(name, kept, changed)         \
  template <class A, class B>                      \
  constexpr A& name(int site, A& a, const B& by) { \
    const auto& b = beside<A>(by);                 \
    if constexpr (requires { a changed b; }) {     \
      if (is_on(site)) {                           \
        a changed b;                               \
        return a;                                  \
      }                                            \
    }                                              \
    a kept b;                                      \
    return a;                                      \
  }
MUTANT_ASSIGN(assign_add, +=, -=)
MUTANT_ASSIGN(assign_subtract, -=, +=)
MUTANT_ASSIGN(assign_multiply, *=, +=)
MUTANT_ASSIGN(assign_divide, /=, *=)
MUTANT_ASSIGN(assign_remainder, %=, +=)
MUTANT_ASSIGN(assign_shift_left, <<=, >>=)
MUTANT_ASSIGN(assign_shift_right, >>=, <<=)
MUTANT_ASSIGN(assign_and, &=, |=)
MUTANT_ASSIGN(assign_or, |=, &=)
MUTANT_ASSIGN(assign_xor, ^=, |=)
#undef MUTANT_ASSIGN

/// && and || turn into one another: an operand of either, and what comes of both, is inverted.
constexpr bool operand(int site, bool value) { return value != is_on(site); }

template <class A>
constexpr auto negate(int site, const A& a) {
  return is_on(site) ? +a : -a;
}
constexpr bool invert(int site, bool a) { return !a != is_on(site); }
/// ++ and -- that do nothing.
template <class A>
constexpr A& increment(int site, A& a) {
  if (!is_on(site)) ++a;
  return a;
}
template <class A>
constexpr A& decrement(int site, A& a) {
  if (!is_on(site)) --a;
  return a;
}

/// A constant one up at `site`, one down at the next; real ones an eighth.
template <class T>
constexpr T constant(int site, const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (is_on(site)) return value == 0 ? T{1} : value * T{1.125};
    if (is_on(site + 1)) return value * T{0.875};
  } else if constexpr (std::is_integral_v<T>) {
    if (is_on(site)) return static_cast<T>(value + 1);
    if (is_on(site + 1)) return static_cast<T>(value - 1);
  }
  return value;
}

/// Tables that the mutant shall reach are made when the program starts.
template <class T>
T made_late(T value) {
  return value;
}

}  // namespace mutants
