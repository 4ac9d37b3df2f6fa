// The state of the processor that floating point depends on: which way it rounds, whether it takes
// subnormals for 0, what it traps.
#pragma once

#include <cstdint>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace reeb {

/// Sets what the specification asks for - nearest, ties to even, subnormals kept, no traps - and
/// puts the host's state back at its end: audio programs and games set another. Every call into the
/// library and each of its threads starts with one. WebAssembly has no such state.
class FloatState {
 public:
  FloatState() : host_(get()) { set(kStandard); }
  ~FloatState() { set(host_); }
  FloatState(const FloatState&) = delete;
  FloatState& operator=(const FloatState&) = delete;

 private:
#if defined(__SSE2__)
  using Bits = uint32_t;
  static constexpr Bits kStandard = 0x1F80;  // MXCSR: all traps masked
  static Bits get() { return _mm_getcsr(); }
  static void write(Bits bits) { _mm_setcsr(bits); }
#elif defined(__aarch64__)
  using Bits = uint64_t;
  static constexpr Bits kStandard = 0;  // FPCR
  static Bits get() {
    Bits bits;
    asm volatile("mrs %0, fpcr" : "=r"(bits));
    return bits;
  }
  static void write(Bits bits) { asm volatile("msr fpcr, %0" : : "r"(bits)); }
#else
  using Bits = uint32_t;
  static constexpr Bits kStandard = 0;
  static Bits get() { return kStandard; }
  static void write(Bits) {}
#endif
  /// Nothing that is read from or written to memory moves across.
  static void set(Bits bits) {
    asm volatile("" : : : "memory");
    write(bits);
    asm volatile("" : : : "memory");
  }

  Bits host_;
};

}  // namespace reeb
