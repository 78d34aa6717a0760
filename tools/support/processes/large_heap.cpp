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

constexpr std::uintptr_t kHugePage = std::uintptr_t{2} << 20U;  // bytes

}  // namespace

void prepare_large_heap([[maybe_unused]] std::size_t bytes) {
#ifdef SPRUNG_GLIBC_HEAP
  mallopt(M_MMAP_MAX, 0);         // large arrays come from the heap, too
  mallopt(M_TRIM_THRESHOLD, -1);  // whose end is never given back
  void* block = std::malloc(bytes + kHugePage);
  if (block == nullptr) return;
  const auto address = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = (address / kHugePage + 1) * kHugePage,
                       end = (address + bytes) / kHugePage * kHugePage + kHugePage;
  ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  // What is before the first huge page would come in small ones. It stays unused, as address space alone.
  [[maybe_unused]] static void* unused = nullptr;
  unused = std::realloc(block, begin - address);
#endif
}

}  // namespace sprung::support
