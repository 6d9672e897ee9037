#include "host_bullet.h"

#include <atomic>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <link.h>
#include <pthread.h>

#include "say.h"

#define WORLD "23btDiscreteDynamicsWorld"
#define MADE_OF \
  "P12btDispatcherP21btBroadphaseInterfaceP18btConstraintSolverP24btCollisionConfiguration"

namespace tandem::preload {
namespace {

constexpr const char* kConstructComplete = "_ZN" WORLD "C1E" MADE_OF;

struct Bullets {
  static constexpr int kMost = 8;  // a process usually has one, or two with plugins of both widths
  HostBullet found[kMost];
  std::atomic<int> count{0};
};
Bullets bullets;

/// A world of another Bullet than the first one found.
struct OtherWorld {
  const void* world;
  const HostBullet* bullet;
  OtherWorld* next;
};
OtherWorld* other_worlds = nullptr;
pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

class Lock {
 public:
  Lock() { pthread_mutex_lock(&mutex); }
  ~Lock() { pthread_mutex_unlock(&mutex); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
};

link_map* mapOf(const void* address) {
  Dl_info info;
  link_map* map = nullptr;
  void** place = reinterpret_cast<void**>(&map);
  return dladdr1(address, &info, place, RTLD_DL_LINKMAP) != 0 ? map : nullptr;
}

bool isOurs(const void* address) {
  static const link_map* const own = mapOf(&bullets);
  return mapOf(address) == own;
}

void* findInScopeOf(const char* file, const char* name) {
  void* object = dlopen(file, RTLD_LAZY | RTLD_NOLOAD);
  if (!object) return nullptr;
  void* symbol = dlsym(object, name);
  dlclose(object);
  return symbol && !isOurs(symbol) ? symbol : nullptr;
}

/// Searches all loaded objects: a library without dependencies of its own may use its loader's
/// Bullet.
void* findAnywhere(const char* name) {
  for (const link_map* map = mapOf(&bullets); map; map = map->l_next)
    if (void* symbol = findInScopeOf(map->l_name, name)) return symbol;
  return nullptr;
}

void* findConstructor(const void* caller) {
  if (void* symbol = dlsym(RTLD_NEXT, kConstructComplete)) return symbol;
  const link_map* map = mapOf(caller);
  void* symbol = map && *map->l_name ? findInScopeOf(map->l_name, kConstructComplete) : nullptr;
  return symbol ? symbol : findAnywhere(kConstructComplete);
}

const char* sonameOf(const link_map& map) {
  const char* strings = nullptr;
  const ElfW(Dyn)* soname = nullptr;
  for (const ElfW(Dyn)* entry = map.l_ld; entry->d_tag != DT_NULL; ++entry) {
    // The loader has converted it to an address.
    if (entry->d_tag == DT_STRTAB) strings = reinterpret_cast<const char*>(entry->d_un.d_ptr);
    if (entry->d_tag == DT_SONAME) soname = entry;
  }
  return strings && soname ? strings + soname->d_un.d_val : "";
}

/// Width of btScalar, from the symbol table's size of a scalar that every libBulletDynamics
/// defines.
std::size_t scalarBytesOf(void* object) {
  void* variable = dlsym(object, "gDeactivationTime");
  Dl_info info;
  const ElfW(Sym)* entry = nullptr;
  void** place = const_cast<void**>(reinterpret_cast<const void**>(&entry));
  if (!variable || dladdr1(variable, &info, place, RTLD_DL_SYMENT) == 0 || !entry) return 0;
  return entry->st_size;
}

template <typename Function>
void take(void* object, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(object, name));
}

/// Takes all functions from one file, whatever the host has loaded in between.
void fill(HostBullet& bullet, void* constructor) {
  const link_map* map = mapOf(constructor);
  bullet.construct_complete = reinterpret_cast<Construct>(constructor);
  // Never closed: these functions must survive the unloading of a plugin.
  void* object =
      map ? dlopen(*map->l_name ? map->l_name : nullptr, RTLD_LAZY | RTLD_NOLOAD) : nullptr;
  if (!object) return;
  bullet.file = strdup(map->l_name);
  bullet.soname = strdup(sonameOf(*map));
  bullet.scalar_bytes = scalarBytesOf(object);
  take(object, "_ZN" WORLD "C2E" MADE_OF, bullet.construct_base);
  take(object, "_ZN" WORLD "D1Ev", bullet.destroy_complete);
  take(object, "_ZN" WORLD "D2Ev", bullet.destroy_base);
  take(object, "_ZN" WORLD "D0Ev", bullet.destroy_deleting);
  take(object, "_ZN" WORLD "14stepSimulationEfif", bullet.step_float);
  take(object, "_ZN" WORLD "14stepSimulationEdid", bullet.step_double);
  take(object, "_ZN" WORLD "15removeRigidBodyEP11btRigidBody", bullet.remove_body);
  take(object, "_ZN" WORLD "21removeCollisionObjectEP17btCollisionObject", bullet.remove_object);
  // The first two entries of a virtual table are an offset and the type.
  if (auto* table = static_cast<const void**>(dlsym(object, "_ZTV" WORLD)))
    bullet.first_virtual = table + 2;
}

const HostBullet* lookUp(void* constructor) {
  const int count = bullets.count.load(std::memory_order_acquire);
  for (int i = 0; i < count; ++i)
    if (bullets.found[i].construct_complete == reinterpret_cast<Construct>(constructor))
      return &bullets.found[i];
  return nullptr;
}

}  // namespace

const HostBullet& findHostBullet(const void* caller) noexcept {
  void* constructor = findConstructor(caller);
  if (!constructor) {
    say("this process makes a btDiscreteDynamicsWorld, but no loaded library has one; leave "
        "libtandem-preload.so out of LD_PRELOAD");
    std::abort();
  }
  if (const HostBullet* known = lookUp(constructor)) return *known;
  HostBullet bullet;
  fill(bullet, constructor);
  const Lock lock;
  if (const HostBullet* known = lookUp(constructor)) return *known;
  const int count = bullets.count.load(std::memory_order_relaxed);
  if (count == Bullets::kMost) {
    say("this process has more than %d Bullets; leave libtandem-preload.so out of LD_PRELOAD",
        count);
    std::abort();
  }
  bullets.found[count] = bullet;
  bullets.count.store(count + 1, std::memory_order_release);
  return bullets.found[count];
}

void rememberWorld(const void* world, const HostBullet& bullet) noexcept {
  if (&bullet == &bullets.found[0]) return;
  const Lock lock;
  other_worlds = new (std::malloc(sizeof(OtherWorld))) OtherWorld{world, &bullet, other_worlds};
}

void forgetWorld(const void* world) noexcept {
  if (bullets.count.load(std::memory_order_acquire) < 2) return;
  const Lock lock;
  for (OtherWorld** place = &other_worlds; *place; place = &(*place)->next) {
    if ((*place)->world != world) continue;
    OtherWorld* gone = *place;
    *place = gone->next;
    std::free(gone);
    return;
  }
}

const HostBullet& bulletOf(const void* world, const void* caller) noexcept {
  const int count = bullets.count.load(std::memory_order_acquire);
  if (count == 1) return bullets.found[0];
  // An unseen world: made by a library that calls its own Bullet directly.
  if (count == 0) return findHostBullet(caller);
  const Lock lock;
  for (const OtherWorld* other = other_worlds; other; other = other->next)
    if (other->world == world) return *other->bullet;
  return bullets.found[0];
}

}  // namespace tandem::preload
