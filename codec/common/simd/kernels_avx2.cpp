#define REEB_KERNEL_NAMESPACE avx2_kernel
#include "codec/common/simd/displacement_kernels_impl.h"
#include "codec/common/simd/kernels_impl.h"
