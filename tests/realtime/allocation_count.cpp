#include "realtime/allocation_count.h"

#include <cstdio>
#include <cstdlib>
#include <new>

#include <execinfo.h>
#include <unistd.h>

#include <LinearMath/btAlignedAllocator.h>

// Three doors to the heap, one counter:
//
//   operator new ----- replaced below ----------.
//   btAlignedAlloc --- btAlignedAllocSetCustom --+--> note() and the real malloc
//   malloc, calloc --- the linker's --wrap -----'     (Eigen's large matrices come this way)

extern "C" {
// The linker makes these names: __wrap_ is called instead of the function, __real_ is the function.
// NOLINTBEGIN(bugprone-reserved-identifier)
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* old, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
int __real_posix_memalign(void** memory, std::size_t alignment, std::size_t size);
}

namespace {

constexpr std::size_t kShown = 3;

thread_local bool counting = false, showing = false;
thread_local std::size_t counted = 0;

void note(const char* door, std::size_t size) {
  if (!counting) return;
  ++counted;
  if (!showing || counted > kShown) return;
  counting = false;  // showing may allocate
  dprintf(STDERR_FILENO, "allocation %zu: %zu bytes by %s\n", counted, size, door);
  void* frames[40];
  backtrace_symbols_fd(frames, backtrace(frames, 40), STDERR_FILENO);
  counting = true;
}

void* take(std::size_t size) {
  note("operator new", size);
  if (void* memory = __real_malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void* takeAligned(std::size_t size, std::align_val_t alignment) {
  note("aligned operator new", size);
  void* memory = nullptr;
  if (__real_posix_memalign(&memory, static_cast<std::size_t>(alignment), size) == 0) return memory;
  throw std::bad_alloc();
}

void* takeForBullet(std::size_t size) {
  note("btAlignedAlloc", size);
  return __real_malloc(size);
}

}  // namespace

extern "C" {
void* __wrap_malloc(std::size_t size) {
  note("malloc", size);
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  note("calloc", count * size);
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  note("realloc", size);
  return __real_realloc(old, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  note("aligned_alloc", size);
  return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  note("posix_memalign", size);
  return __real_posix_memalign(memory, alignment, size);
}
// NOLINTEND(bugprone-reserved-identifier)
}

// The standard library's array and nothrow forms call these.
void* operator new(std::size_t size) { return take(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return takeAligned(size, alignment);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace tandem::test {

AllocationCount::AllocationCount(bool shows) {
  void* frame = nullptr;
  backtrace(&frame, 1);  // loads its libraries now, not during a count
  counted = 0;
  showing = shows;
  counting = true;
}

AllocationCount::~AllocationCount() { counting = false; }

std::size_t AllocationCount::count() const noexcept { return counted; }

void AllocationCount::watchBullet() { btAlignedAllocSetCustom(takeForBullet, std::free); }

}  // namespace tandem::test
