#include "realtime/lock_count.h"

#include <dlfcn.h>
#include <pthread.h>

namespace {

thread_local bool counting = false;
thread_local std::size_t counted = 0;

}  // namespace

// Defined in the program, so the dynamic linker finds it before the library's.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const Lock lock = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  counted += counting;
  return lock(mutex);
}

namespace tandem::test {

LockCount::LockCount() {
  counted = 0;
  counting = true;
}

LockCount::~LockCount() { counting = false; }

std::size_t LockCount::count() const noexcept { return counted; }

}  // namespace tandem::test
