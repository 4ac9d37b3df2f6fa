#define REEB_INSTRUCTION_SET kAvx512
#include "codec/common/kernels_impl.h"
