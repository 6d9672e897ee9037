#include "shared_world.h"

#include <atomic>
#include <cstdio>
#include <cstring>

#include <dlfcn.h>
#include <pthread.h>

#include "process.h"
#include "say.h"
#include "static_bullet.h"

namespace tandem::preload {
namespace {

/// File names of the supported Bullets. Only its name tells a Bullet's version.
constexpr const char* kFloatBullet = "libBulletDynamics.so." TANDEM_BULLET_VERSION;
constexpr const char* kDoubleBullet = "libBulletDynamics-float64.so." TANDEM_BULLET_VERSION;

const char* config = nullptr;  ///< null: none, or for another process
bool is_told = false;          ///< the reason for doing nothing was already reported

pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
int worlds = 0;
const TandemPreloadDoor* door = nullptr;
bool was_opened = false;
std::atomic<const void*> taken{nullptr};

const char* describe(std::size_t scalar_bytes) {
  return scalar_bytes == 8 ? "8-byte (double)" : scalar_bytes == 4 ? "4-byte (float)" : "unknown";
}

/// True for Debian's Bullet of the adaptors' version.
bool canAttachTo(const HostBullet& bullet) {
  const bool is_float = !std::strcmp(bullet.soname, kFloatBullet) && bullet.scalar_bytes == 4;
  const bool is_double = !std::strcmp(bullet.soname, kDoubleBullet) && bullet.scalar_bytes == 8;
  if (!is_float && !is_double) {
    say("%s makes its worlds with %s (btScalar %s), not with %s or %s: it runs on without Tandem",
        processName(), *bullet.file ? bullet.file : "a Bullet of its own",
        describe(bullet.scalar_bytes), kFloatBullet, kDoubleBullet);
    return false;
  }
  if (!bullet.construct_base || !bullet.destroy_base || !bullet.destroy_deleting ||
      !bullet.first_virtual ||
      !(is_float ? bullet.step_float != nullptr : bullet.step_double != nullptr)) {
    say("%s lacks symbols of btDiscreteDynamicsWorld: %s runs on without Tandem", bullet.file,
        processName());
    return false;
  }
  return true;
}

/// True if the end of a world can be intercepted, so that its site does not outlive it. A Bullet
/// linked with -Bsymbolic-functions calls its virtual functions directly.
bool isSeenEnding(const HostBullet& bullet) {
  const auto* const* functions = static_cast<const void* const*>(bullet.first_virtual);
  if (functions[0] != reinterpret_cast<const void*>(bullet.destroy_complete)) return true;
  say("%s calls its own functions directly, so the end of a world cannot be seen: %s runs on "
      "without Tandem",
      bullet.file, processName());
  return false;
}

/// Path of tandem/preload-float.so or -float64.so beside this library.
bool findAdaptor(std::size_t scalar_bytes, char* path, std::size_t size) {
  Dl_info own;
  if (dladdr(reinterpret_cast<const void*>(&findAdaptor), &own) == 0) return false;
  const char* slash = std::strrchr(own.dli_fname, '/');
  const int folder = slash ? static_cast<int>(slash - own.dli_fname + 1) : 0;
  const int length = std::snprintf(path, size, "%.*standem/preload-%s.so", folder, own.dli_fname,
                                   scalar_bytes == 8 ? "float64" : "float");
  return length > 0 && static_cast<std::size_t>(length) < size;
}

const TandemPreloadDoor* loadAdaptor(const HostBullet& bullet) {
  char path[4096];
  if (!findAdaptor(bullet.scalar_bytes, path, sizeof path)) return nullptr;
  // RTLD_LOCAL keeps the adaptor's symbols away from the host.
  void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  const void* symbol = library ? dlsym(library, kTandemPreloadDoor) : nullptr;
  if (!symbol) {
    say("the Bullet of %s has %s btScalar, and the adaptor for it cannot be loaded: %s; install "
        "it, "
        "or %s runs on without Tandem",
        processName(), describe(bullet.scalar_bytes), dlerror(), processName());
    return nullptr;
  }
  const auto* found = static_cast<const TandemPreloadDoor*>(symbol);
  if (found->scalarBytes() == bullet.scalar_bytes) return found;
  say("Bullet scalar width mismatch: the Bullet of %s has %s btScalar, %s was built for %s; %s "
      "runs "
      "on without Tandem",
      processName(), describe(bullet.scalar_bytes), path, describe(found->scalarBytes()),
      processName());
  return nullptr;
}

/// Opens the adaptor with the first world; tries only once.
void open(const HostBullet& bullet) {
  was_opened = true;
  is_told = true;
  if (!canAttachTo(bullet) || !isSeenEnding(bullet)) return;
  const TandemPreloadDoor* found = loadAdaptor(bullet);
  if (found && found->open(config, processName())) door = found;
}

}  // namespace

void lookAtProgram() noexcept {
  const char* named = findConfig();
  if (!named || !isWanted(named)) return;
  config = named;
  const char* carrier = findStaticBullet();
  if (!carrier) return;
  is_told = true;
  say("%s has Bullet linked in statically, where nobody can come between: %s runs on without "
      "Tandem",
      *carrier ? carrier : processName(), processName());
}

void sayIfNothingCame() noexcept {
  if (config && !is_told)
    say("%s has made no world with a dynamically linked Bullet: Tandem had nothing to do; if "
        "another "
        "process was meant, write process = \"its name\" into %s",
        processName(), config);
}

void offerWorld(void* world, const HostBullet& bullet) noexcept {
  if (!config) {
    if (is_told || findConfig()) return;  // the config is for another process
    is_told = true;
    say("%s makes a Bullet world, but TANDEM_PRELOAD names no config: it runs without Tandem",
        processName());
    return;
  }
  pthread_mutex_lock(&mutex);
  const int number = ++worlds;
  if (!was_opened) open(bullet);
  if (door && door->scalarBytes() == bullet.scalar_bytes && door->takeWorld(world, number))
    taken.store(world, std::memory_order_release);
  pthread_mutex_unlock(&mutex);
}

const TandemPreloadDoor* adaptorOf(const void* world) noexcept {
  return taken.load(std::memory_order_acquire) == world ? door : nullptr;
}

void endWorld(void* world, const HostBullet& bullet) noexcept {
  if (!adaptorOf(world)) return;
  // Bullet's destructor does this first. No function of a derived class may be called now, because
  // its members are gone.
  *static_cast<const void**>(world) = bullet.first_virtual;
  door->endWorld();
  taken.store(nullptr, std::memory_order_release);
}

}  // namespace tandem::preload
