#define REEB_INSTRUCTION_SET kBase
#include "codec/common/kernels_impl.h"
