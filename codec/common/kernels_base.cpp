#define REEB_KERNEL_NAMESPACE base_kernel
#include "codec/common/displacement_kernels_impl.h"
#include "codec/common/kernels_impl.h"
