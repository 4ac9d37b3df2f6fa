#define REEB_KERNEL_NAMESPACE base_kernel
#include "codec/common/kernels_impl.h"
