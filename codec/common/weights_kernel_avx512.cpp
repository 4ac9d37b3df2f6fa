#define REEB_KERNEL_NAMESPACE avx512_kernel
#include "codec/common/weights_kernel_impl.h"
