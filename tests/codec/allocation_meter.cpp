#include "tests/codec/allocation_meter.h"

#include <atomic>
#include <cerrno>
#include <cstdlib>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define REEB_SANITIZER_HEAP
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define REEB_SANITIZER_HEAP
#endif

#ifdef REEB_SANITIZER_HEAP
#include <sanitizer/allocator_interface.h>
#elif defined(__GLIBC__)
#include <malloc.h>
#endif

namespace {

// Blocks that are there before anything is counted may be released: that is less than none.
std::atomic<ptrdiff_t> held{0};
std::atomic<ptrdiff_t> most{0};

[[maybe_unused]] void add(size_t size) {
  const ptrdiff_t now = held += static_cast<ptrdiff_t>(size);
  ptrdiff_t before = most;
  while (before < now && !most.compare_exchange_weak(before, now)) {
  }
}

}  // namespace

#ifdef REEB_SANITIZER_HEAP
// The sanitizer's heap tells of every block.
namespace {

void note_block(const volatile void* block, size_t size) {
  if (block != nullptr) add(size);
}

void note_release(const volatile void* block) {
  if (block == nullptr) return;
  held -= static_cast<ptrdiff_t>(__sanitizer_get_allocated_size(const_cast<const void*>(block)));
}

[[maybe_unused]] const int hooked =
    __sanitizer_install_malloc_and_free_hooks(note_block, note_release);

}  // namespace

#elif defined(__GLIBC__)
// What glibc puts in place of its own functions, operator new and the C library's calls included.
extern "C" {

void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
void __libc_free(void* block);

static void* note(void* block) {
  if (block != nullptr) add(malloc_usable_size(block));
  return block;
}

void* malloc(size_t size) noexcept { return note(__libc_malloc(size)); }
void* calloc(size_t count, size_t size) noexcept { return note(__libc_calloc(count, size)); }
void* memalign(size_t alignment, size_t size) noexcept {
  return note(__libc_memalign(alignment, size));
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return note(__libc_memalign(alignment, size));
}
int posix_memalign(void** out, size_t alignment, size_t size) noexcept {
  *out = note(__libc_memalign(alignment, size));
  return *out == nullptr ? ENOMEM : 0;
}

// Both blocks are there while one is copied.
void* realloc(void* block, size_t size) noexcept {
  const size_t before = block != nullptr ? malloc_usable_size(block) : 0;
  void* const out = note(__libc_realloc(block, size));
  if (out != nullptr || size == 0) held -= static_cast<ptrdiff_t>(before);
  return out;
}

void free(void* block) noexcept {
  if (block == nullptr) return;
  held -= static_cast<ptrdiff_t>(malloc_usable_size(block));
  __libc_free(block);
}
}

namespace {

// Blocks of their own pages would count up to a page more than is asked for.
[[maybe_unused]] const int no_mappings = mallopt(M_MMAP_THRESHOLD, 1 << 25);

}  // namespace
#endif

namespace reeb::test {

AllocationMeter::AllocationMeter() : before_(held) { most = before_; }
size_t AllocationMeter::peak() const {
  const ptrdiff_t now = most;
  return now > before_ ? static_cast<size_t>(now - before_) : 0;
}

}  // namespace reeb::test
