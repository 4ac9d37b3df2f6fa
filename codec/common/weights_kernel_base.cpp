#define REEB_KERNEL_NAMESPACE base_kernel
#include "codec/common/weights_kernel_impl.h"
