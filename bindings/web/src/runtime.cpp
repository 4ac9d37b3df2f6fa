// What the C++ runtime for WebAssembly leaves open: there is no memory, or an exception, which the
// decoder throws for nothing else. Both end the instance, which JavaScript throws away. Some stand
// in for what the library has, too, which takes 16 kB to catch and to print.
#include <cstddef>
#include <cstdlib>
#include <new>

extern "C" {

[[noreturn]] __attribute__((import_module("reeb"), import_name("out_of_memory"))) void
reeb_out_of_memory();

void abort() { reeb_out_of_memory(); }
void* __cxa_allocate_exception(size_t) { reeb_out_of_memory(); }
void __cxa_free_exception(void*) {}
[[noreturn]] void __cxa_throw(void*, void*, void (*)(void*)) { reeb_out_of_memory(); }
[[noreturn]] void __cxa_rethrow() { reeb_out_of_memory(); }
void* __cxa_begin_catch(void*) { return nullptr; }
void __cxa_end_catch() {}
void abort_message(const char*, ...) { reeb_out_of_memory(); }
int __cxa_atexit(void (*)(void*), void*, void*) { return 0; }

// Used as they are by the module's other side.
__attribute__((export_name("allocate"))) void* reeb_allocate(size_t size) {
  void* const block = std::malloc(size > 0 ? size : 1);
  if (block == nullptr) reeb_out_of_memory();
  return block;
}
__attribute__((export_name("release"))) void reeb_release(void* block) { std::free(block); }

}  // extern "C"

// The library's own say, in print, that something is wrong with a container or that terminate is
// called.
namespace std {
inline namespace __2 {
void __libcpp_verbose_abort(const char*, ...) { reeb_out_of_memory(); }
}  // namespace __2
[[noreturn]] void terminate() noexcept { reeb_out_of_memory(); }
}  // namespace std

void* operator new(size_t size) { return reeb_allocate(size); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return std::malloc(size); }
void* operator new(size_t size, std::align_val_t alignment) {
  const auto step = static_cast<size_t>(alignment);
  void* const block = std::aligned_alloc(step, (size + step - 1) / step * step);
  if (block == nullptr) reeb_out_of_memory();
  return block;
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, size_t, std::align_val_t) noexcept { std::free(block); }
