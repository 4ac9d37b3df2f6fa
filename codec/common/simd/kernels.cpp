#include "codec/common/simd/kernels.h"

#include "codec/common/simd/displacement_kernels.h"

namespace reeb {

namespace base_kernel {
extern const Kernels kKernels;
extern const DisplacementKernels kDisplacementKernels;
}  // namespace base_kernel
#ifdef REEB_X86_KERNELS
namespace avx2_kernel {
extern const Kernels kKernels;
extern const DisplacementKernels kDisplacementKernels;
}  // namespace avx2_kernel
namespace avx512_kernel {
extern const Kernels kKernels;
extern const DisplacementKernels kDisplacementKernels;
}  // namespace avx512_kernel
#endif

#ifdef REEB_X86_KERNELS
namespace {

/// All that the kernels of this instruction set are compiled for.
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vnni");
}

}  // namespace
#endif

Kernels fastest_kernels() {
#ifdef REEB_X86_KERNELS
  if (has_avx512()) return avx512_kernel::kKernels;
  if (__builtin_cpu_supports("avx2")) return avx2_kernel::kKernels;
#endif
  return base_kernel::kKernels;
}

DisplacementKernels fastest_displacement_kernels() {
#ifdef REEB_X86_KERNELS
  if (has_avx512()) return avx512_kernel::kDisplacementKernels;
  if (__builtin_cpu_supports("avx2")) return avx2_kernel::kDisplacementKernels;
#endif
  return base_kernel::kDisplacementKernels;
}

}  // namespace reeb
