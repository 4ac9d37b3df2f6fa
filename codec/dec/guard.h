// No exception leaves the decoder.
#pragma once

#include <utility>

#include "bitstream/status.h"

namespace reeb {

/// What `function` returns; where it throws, which only a lack of memory (or of threads) makes it
/// do, kOutOfMemory.
template <class Function>
Status guarded(Function&& function) noexcept {
  try {
    return std::forward<Function>(function)();
  } catch (...) {
    return Status::out_of_memory();
  }
}

}  // namespace reeb
