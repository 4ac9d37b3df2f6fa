#include "codec/common/kernels.h"

namespace reeb {

namespace base_kernel {
extern const Kernels kKernels;
}
#ifdef REEB_X86_KERNELS
namespace avx2_kernel {
extern const Kernels kKernels;
}
namespace avx512_kernel {
extern const Kernels kKernels;
}
#endif

Kernels fastest_kernels() {
#ifdef REEB_X86_KERNELS
  if (__builtin_cpu_supports("avx512f")) return avx512_kernel::kKernels;
  if (__builtin_cpu_supports("avx2")) return avx2_kernel::kKernels;
#endif
  return base_kernel::kKernels;
}

}  // namespace reeb
