// Asking a long computation to end early.
#pragma once

#include <atomic>
#include <cstdint>

namespace reeb {

/// Thrown where a computation ends early; the decoder's calls give kCancelled then.
struct Stopped {};

/// True from the first request after its construction on; the default one never is.
class StopToken {
 public:
  StopToken() = default;
  /// `requests`, which counts them, must outlive the token.
  explicit StopToken(const std::atomic<uint32_t>& requests)
      : requests_(&requests), seen_(requests.load()) {}

  bool requested() const { return requests_ != nullptr && requests_->load() != seen_; }
  /// Throws Stopped where it is requested. Cheap enough for every vertex.
  void check() const {
    if (requested()) throw Stopped();
  }

 private:
  const std::atomic<uint32_t>* requests_ = nullptr;
  uint32_t seen_ = 0;
};

}  // namespace reeb
