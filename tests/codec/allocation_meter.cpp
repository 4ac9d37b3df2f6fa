#include "tests/codec/allocation_meter.h"

#include <atomic>
#include <cstdlib>
#include <new>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

std::atomic<size_t> held{0};
std::atomic<size_t> most{0};

size_t size_of([[maybe_unused]] void* block) {
#ifdef __GLIBC__
  return malloc_usable_size(block);
#else
  return 0;
#endif
}

void* note(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  const size_t now = held += size_of(block);
  size_t before = most;
  while (before < now && !most.compare_exchange_weak(before, now)) {
  }
  return block;
}

void release(void* block) {
  if (block == nullptr) return;
  held -= size_of(block);
  std::free(block);
}

}  // namespace

void* operator new(size_t size) { return note(std::malloc(size > 0 ? size : 1)); }
void* operator new(size_t size, const std::nothrow_t&) noexcept {
  void* const block = std::malloc(size > 0 ? size : 1);
  return block == nullptr ? nullptr : note(block);
}
void* operator new(size_t size, std::align_val_t alignment) {
  const auto a = static_cast<size_t>(alignment);
  return note(std::aligned_alloc(a, (size + a - 1) / a * a));
}
void operator delete(void* block) noexcept { release(block); }
void operator delete(void* block, size_t) noexcept { release(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, size_t, std::align_val_t) noexcept { release(block); }

namespace reeb::test {

AllocationMeter::AllocationMeter() : before_(held) { most = before_; }
size_t AllocationMeter::peak() const { return most - before_; }

}  // namespace reeb::test
