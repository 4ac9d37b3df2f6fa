// The kernels of every instruction set that this processor has.
#pragma once

#include <vector>

#include "codec/common/simd/kernels.h"

namespace reeb {

namespace base_kernel {
extern const Kernels kKernels;
}
namespace avx2_kernel {
extern const Kernels kKernels;
}

namespace test {

/// Those that every processor runs come first.
inline std::vector<Kernels> kernel_sets() {
  std::vector<Kernels> out{base_kernel::kKernels, fastest_kernels()};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) out.push_back(avx2_kernel::kKernels);
#endif
  return out;
}

}  // namespace test
}  // namespace reeb
