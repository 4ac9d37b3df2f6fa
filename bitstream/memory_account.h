// Who holds how much of the memory that the caller allows.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

namespace reeb {

/// Bytes in use, never more than a limit. Any thread may call.
class MemoryAccount {
 public:
  explicit MemoryAccount(uint64_t limit) : limit_(limit) {}

  /// False, and nothing taken, where that would be more than the limit.
  bool take(uint64_t bytes) {
    uint64_t used = used_.load();
    do {
      if (bytes > limit_ - used) return false;
    } while (!used_.compare_exchange_weak(used, used + bytes));
    uint64_t peak = peak_.load();
    while (peak < used + bytes && !peak_.compare_exchange_weak(peak, used + bytes)) {
    }
    return true;
  }
  void give(uint64_t bytes) { used_ -= bytes; }
  uint64_t used() const { return used_; }
  uint64_t peak() const { return peak_; }
  uint64_t limit() const { return limit_; }

 private:
  const uint64_t limit_;
  std::atomic<uint64_t> used_{0}, peak_{0};
};

/// Bytes taken from an account, given back at the end of the lease's life.
class Lease {
 public:
  Lease() = default;
  Lease(Lease&& other) noexcept
      : account_(std::exchange(other.account_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  Lease& operator=(Lease&& other) noexcept {
    std::swap(account_, other.account_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~Lease() { shrink(0); }

  /// Takes `bytes` more; false where the account has not enough left.
  bool grow(MemoryAccount& account, uint64_t bytes) {
    if (!account.take(bytes)) return false;
    account_ = &account;
    bytes_ += bytes;
    return true;
  }
  /// Gives back what is beyond `bytes`.
  void shrink(uint64_t bytes) {
    if (bytes >= bytes_) return;
    account_->give(bytes_ - bytes);
    bytes_ = bytes;
  }
  /// Hands `bytes` of it, or all, to a lease of their own.
  Lease split(uint64_t bytes) {
    Lease part;
    part.account_ = account_;
    part.bytes_ = bytes < bytes_ ? bytes : bytes_;
    bytes_ -= part.bytes_;
    return part;
  }
  uint64_t bytes() const { return bytes_; }

 private:
  MemoryAccount* account_ = nullptr;
  uint64_t bytes_ = 0;
};

/// Bytes that up to `count` texts of so many bytes together take beside their objects, which hold
/// short ones themselves.
inline uint64_t text_memory(uint64_t bytes, uint64_t count) {
  constexpr uint64_t kShortest = 16, kRounding = 24;  // of those apart; by which blocks are longer
  return bytes + kRounding * std::min(count, bytes / kShortest);
}
inline uint64_t text_memory(const std::string& text) { return text_memory(text.size(), 1); }

}  // namespace reeb
