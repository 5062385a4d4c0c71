#include "fuzz/allocation_counter.hpp"

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif

namespace {

std::atomic<std::int64_t> held_bytes{0}, peak_bytes{0}, start_bytes{0};

void count(std::int64_t n_bytes) {
  const std::int64_t now = held_bytes.fetch_add(n_bytes, std::memory_order_relaxed) + n_bytes;
  std::int64_t peak = peak_bytes.load(std::memory_order_relaxed);
  while (now > peak && !peak_bytes.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
  }
}

}  // namespace

#if defined(__SANITIZE_ADDRESS__)

// Of sanitizer/allocator_interface.h, which Debian's g++ does not bring.
extern "C" {
std::size_t __sanitizer_get_allocated_size(const volatile void* at);
int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                              void (*on_free)(const volatile void*));
}

namespace {

void on_malloc(const volatile void* /*at*/, std::size_t n_bytes) {
  count(static_cast<std::int64_t>(n_bytes));
}
void on_free(const volatile void* at) {
  if (at != nullptr) count(-static_cast<std::int64_t>(__sanitizer_get_allocated_size(at)));
}

const bool kInstalled = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0;

}  // namespace

#else

namespace {
constexpr bool kInstalled = true;
}  // namespace

// The program's own definitions come before those of the C library, for every library it loads.
// The size counted is that of the block handed out, which is what free() can find again.
extern "C" {

void* __libc_malloc(std::size_t);
void __libc_free(void*);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t n_bytes) {
  void* const at = __libc_malloc(n_bytes);
  if (at != nullptr) count(static_cast<std::int64_t>(malloc_usable_size(at)));
  return at;
}
void free(void* at) {
  if (at == nullptr) return;
  count(-static_cast<std::int64_t>(malloc_usable_size(at)));
  __libc_free(at);
}
void* calloc(std::size_t n, std::size_t n_bytes) {
  void* const at = __libc_calloc(n, n_bytes);
  if (at != nullptr) count(static_cast<std::int64_t>(malloc_usable_size(at)));
  return at;
}
void* realloc(void* before, std::size_t n_bytes) {
  const auto n_before =
      before == nullptr ? 0 : static_cast<std::int64_t>(malloc_usable_size(before));
  void* const at = __libc_realloc(before, n_bytes);
  if (at != nullptr) {
    count(static_cast<std::int64_t>(malloc_usable_size(at)) - n_before);
  } else if (n_bytes == 0) {
    count(-n_before);
  }
  return at;
}
void* memalign(std::size_t alignment, std::size_t n_bytes) {
  void* const at = __libc_memalign(alignment, n_bytes);
  if (at != nullptr) count(static_cast<std::int64_t>(malloc_usable_size(at)));
  return at;
}
void* aligned_alloc(std::size_t alignment, std::size_t n_bytes) {
  return memalign(alignment, n_bytes);
}
int posix_memalign(void** at, std::size_t alignment, std::size_t n_bytes) {
  *at = memalign(alignment, n_bytes);
  return *at == nullptr ? ENOMEM : 0;
}

}  // extern "C"

#endif

namespace manoscope::fuzz {

std::int64_t AllocationCounter::held() { return held_bytes.load(std::memory_order_relaxed); }

std::int64_t AllocationCounter::peak() {
  return peak_bytes.load(std::memory_order_relaxed) - start_bytes.load(std::memory_order_relaxed);
}

void AllocationCounter::restart() {
  start_bytes.store(held());
  peak_bytes.store(held());
}

bool AllocationCounter::works() {
  if (!kInstalled) return false;
  restart();
  void* const volatile at = std::malloc(12345);
  std::free(at);
  return peak() >= 12345;
}

}  // namespace manoscope::fuzz
