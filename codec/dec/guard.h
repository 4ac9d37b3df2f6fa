// What surrounds a call of the decoder: no exception leaves it, and it computes as the
// specification says, however the host does.
#pragma once

#include <utility>

#include "bitstream/status.h"
#include "codec/common/base/float_state.h"
#include "codec/common/base/stop.h"

namespace reeb {

/// What `function` returns. Where it throws: kCancelled, if it was asked to stop, else
/// kOutOfMemory, since nothing but a lack of memory (or of threads) makes it do so.
template <class Function>
Status guarded(Function&& function) noexcept {
  const FloatState state;
  try {
    return std::forward<Function>(function)();
  } catch (const Stopped&) {
    return Status::cancelled();
  } catch (...) {
    return Status::out_of_memory();
  }
}

}  // namespace reeb
