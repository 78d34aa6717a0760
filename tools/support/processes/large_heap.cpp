#include "tools/support/processes/large_heap.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>

// The address sanitizer has a heap of its own.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define SPRUNG_GLIBC_HEAP 1
#include <malloc.h>
#endif

namespace sprung::support {

namespace {

constexpr std::uintptr_t kPage = 4096;

}  // namespace

void prepare_large_heap([[maybe_unused]] std::size_t bytes) {
#ifdef SPRUNG_GLIBC_HEAP
  mallopt(M_MMAP_MAX, 0);         // large arrays come from the heap, too
  mallopt(M_TRIM_THRESHOLD, -1);  // whose end is never given back
  void* block = std::malloc(bytes);
  if (block == nullptr) return;
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(block) + kPage - 1) / kPage * kPage;
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(block) + bytes) / kPage * kPage;
  if (end > begin) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  std::free(block);
#endif
}

}  // namespace sprung::support
