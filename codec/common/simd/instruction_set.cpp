#include "codec/common/simd/instruction_set.h"

#include <array>

namespace reeb {

namespace {

constexpr std::array kSets = {InstructionSet::kBase, InstructionSet::kAvx2,
                              InstructionSet::kAvx512};

/// How many of them this processor has.
size_t set_count() {
#if defined(__x86_64__) && defined(__LP64__)
  if (!__builtin_cpu_supports("avx2")) return 1;
  // All that the kernels of the widest set are compiled for.
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vnni");
  return avx512 ? 3 : 2;
#else
  return 1;
#endif
}

}  // namespace

std::span<const InstructionSet> instruction_sets() {
  static const size_t count = set_count();
  return std::span(kSets).first(count);
}

}  // namespace reeb
