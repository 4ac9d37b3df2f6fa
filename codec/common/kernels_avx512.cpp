#define REEB_KERNEL_NAMESPACE avx512_kernel
#include "codec/common/kernels_impl.h"
