#define REEB_INSTRUCTION_SET kAvx2
#include "codec/common/kernels_impl.h"
