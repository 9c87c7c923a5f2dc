#pragma once

// Include in one source file of a program only: it replaces malloc and its family.

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>

namespace lodestar::test {

/// What the program does with the heap: malloc's family, and so operator new and Eigen as well.
struct HeapWatch {
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  static constexpr bool kWorks = true;
#else
  static constexpr bool kWorks = false;
#endif
  static inline std::atomic<long> allocations{0};   ///< since the program started
  static inline std::atomic<std::size_t> bytes{0};  ///< held now
  static inline std::atomic<std::size_t> peak{0};   ///< the most that was held since it was set

  static void* took(void* block) {
    ++allocations;
    bytes += malloc_usable_size(block);
    peak = std::max(peak.load(), bytes.load());
    return block;
  }
  static void* gives(void* block) {
    bytes -= malloc_usable_size(block);
    return block;
  }
};

}  // namespace lodestar::test

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) noexcept { return lodestar::test::HeapWatch::took(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) noexcept {
  return lodestar::test::HeapWatch::took(__libc_calloc(count, size));
}
void* realloc(void* block, std::size_t size) noexcept {
  return lodestar::test::HeapWatch::took(__libc_realloc(lodestar::test::HeapWatch::gives(block), size));
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return lodestar::test::HeapWatch::took(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  *block = memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
void free(void* block) noexcept { __libc_free(lodestar::test::HeapWatch::gives(block)); }
}
#endif
