// Decoder of integers that ends with whoever asks it to: its users look for its
// end again and again.
#pragma once

#include <cstdint>
#include <span>

#include "codec/common/base/stop.h"
#include "entropy/interval_coder.h"

namespace reeb {

class StoppableDecoder : public IntervalDecoder {
 public:
  StoppableDecoder(std::span<const uint8_t> bytes, const StopToken& stop)
      : IntervalDecoder(bytes), stop_(stop) {}

  /// As of IntervalDecoder; throws Stopped.
  bool overrun() const {
    stop_.check();
    return IntervalDecoder::overrun();
  }

 private:
  StopToken stop_;
};

}  // namespace reeb
