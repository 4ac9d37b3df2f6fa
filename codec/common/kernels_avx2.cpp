#define REEB_KERNEL_NAMESPACE avx2_kernel
#include "codec/common/displacement_kernels_impl.h"
#include "codec/common/kernels_impl.h"
