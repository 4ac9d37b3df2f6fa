#define REEB_KERNEL_NAMESPACE avx2_kernel
#include "codec/common/weights_kernel_impl.h"
