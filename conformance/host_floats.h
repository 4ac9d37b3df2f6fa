// States of floating point that a host may have when it calls.
#pragma once

#include <cfenv>
#include <string_view>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace reeb::test {

/// Subnormals become 0, as results and as operands, where the processor can do so.
inline bool flush_subnormals() {
#if defined(__SSE2__)
  constexpr unsigned kFlush = 0x8040;  // FTZ, DAZ
  _mm_setcsr(_mm_getcsr() | kFlush);
#elif defined(__aarch64__)
  constexpr unsigned long kFlush = 1ul << 24;  // FZ
  unsigned long bits;
  asm volatile("mrs %0, fpcr" : "=r"(bits));
  asm volatile("msr fpcr, %0" : : "r"(bits | kFlush));
#endif
  return true;
}

/// up, down, zero or flush; false for anything else.
inline bool set_host_floats(std::string_view state) {
  if (state == "up") return std::fesetround(FE_UPWARD) == 0;
  if (state == "down") return std::fesetround(FE_DOWNWARD) == 0;
  if (state == "zero") return std::fesetround(FE_TOWARDZERO) == 0;
  return state == "flush" && flush_subnormals();
}

}  // namespace reeb::test
