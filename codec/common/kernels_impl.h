// Bodies of the kernels of all parts, for the instruction set REEB_INSTRUCTION_SET. Every file that
// includes this is compiled for one, and is the only one for it.
#pragma once

#include "codec/common/simd/instruction_set.h"

namespace reeb {
namespace {
constexpr InstructionSet kCompiledFor = InstructionSet::REEB_INSTRUCTION_SET;
}
}  // namespace reeb

#include "codec/common/fast/lane_kernels_impl.h"
#include "codec/common/fast/lane_weight_kernels_impl.h"
#include "codec/common/lossless/displacement_kernels_impl.h"
#include "codec/common/prediction/weight_kernels_impl.h"
#include "codec/common/synthesis/sum_kernels_impl.h"
