// The same arithmetic for several instruction sets, chosen at run time. Every element of a vector
// keeps its own order of operations, so that any width gives the same bits.
#pragma once

#include <cstdint>
#include <span>

namespace reeb {

enum class InstructionSet : uint8_t { kBase, kAvx2, kAvx512 };

/// Those that kernels are compiled for and this processor has, the quickest last.
std::span<const InstructionSet> instruction_sets();

/// The kernels of a part of the codec, a struct of functions, compiled for `set`: each part's file
/// of bodies defines it, and codec/common/kernels_*.cpp compile these.
template <class Kernels, InstructionSet set>
const Kernels& compiled_kernels();

/// `set`: one of `instruction_sets`.
template <class Kernels>
const Kernels& kernels_for(InstructionSet set) {
#if defined(__x86_64__) && defined(__LP64__)
  if (set == InstructionSet::kAvx512) return compiled_kernels<Kernels, InstructionSet::kAvx512>();
  if (set == InstructionSet::kAvx2) return compiled_kernels<Kernels, InstructionSet::kAvx2>();
#endif
  return compiled_kernels<Kernels, InstructionSet::kBase>();
}

/// The quickest that this processor has.
template <class Kernels>
const Kernels& fastest_kernels() {
  return kernels_for<Kernels>(instruction_sets().back());
}

}  // namespace reeb
