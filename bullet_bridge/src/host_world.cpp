#include "tandem/bullet_bridge/host_world.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/coordination/types.h"

//   Bullet ─► [another layer ─►] our tick ─► whatever was in the slot before us
//
// Bullet's callbacks get the world and nothing else (the user pointer is the host's), so a table
// finds our state by the world. When another layer sits on top of a detached link of ours and
// somebody attaches again, our function is twice in one chain: the outermost call is the newest
// link.

namespace tandem {
namespace {

/// Reads the callbacks that Bullet keeps protected. Naming a protected member through a derived
/// class is legal C++; nothing is cast.
struct TickSlots : btDynamicsWorld {
  static btInternalTickCallback preTick(const btDynamicsWorld& world) {
    return world.*(&TickSlots::m_internalPreTickCallback);
  }
  static btInternalTickCallback postTick(const btDynamicsWorld& world) {
    return world.*(&TickSlots::m_internalTickCallback);
  }
};

/// One time that our tick function stands in a slot's chain.
struct Link {
  btInternalTickCallback below = nullptr;  // what stood in the slot before
  HostStepListener* listener = nullptr;    // null: detached, only calls through
};

/// Our links in one slot of one world, oldest first, and how many of them are being called now.
struct Slot {
  std::vector<Link> links;
  std::size_t depth = 0;

  [[nodiscard]] bool hasListener() const {
    for (const Link& link : links) {
      if (link.listener != nullptr) return true;
    }
    return false;
  }
};

struct WorldSlots {
  Slot pre;
  Slot post;
};

/// All attached worlds of the process. The table is guarded; what it holds belongs to the world's
/// thread.
class AttachedWorlds {
 public:
  WorldSlots* find(const btDynamicsWorld* world) {
    // A thread mostly steps one world, twice per step.
    thread_local Found last;
    const std::uint64_t changes = changes_.load(std::memory_order_acquire);
    if (last.world == world && last.changes == changes) return last.slots;
    const std::shared_lock lock(mutex_);
    const auto found = worlds_.find(world);
    last = {world, found == worlds_.end() ? nullptr : found->second.get(), changes};
    return last.slots;
  }
  WorldSlots& findOrAdd(const btDynamicsWorld* world) {
    const std::unique_lock lock(mutex_);
    changes_.fetch_add(1, std::memory_order_release);
    std::unique_ptr<WorldSlots>& slots = worlds_[world];
    if (!slots) slots = std::make_unique<WorldSlots>();
    return *slots;
  }
  void forget(const btDynamicsWorld* world) {
    const std::unique_lock lock(mutex_);
    changes_.fetch_add(1, std::memory_order_release);
    worlds_.erase(world);
  }

 private:
  /// What a thread found last, good until the table changes.
  struct Found {
    const btDynamicsWorld* world = nullptr;
    WorldSlots* slots = nullptr;
    std::uint64_t changes = 0;
  };

  std::shared_mutex mutex_;
  std::atomic<std::uint64_t> changes_{1};
  std::unordered_map<const btDynamicsWorld*, std::unique_ptr<WorldSlots>> worlds_;
};

AttachedWorlds& attachedWorlds() {
  // Never destroyed: worlds of static lifetime may still step while the process ends.
  static AttachedWorlds& worlds = *new AttachedWorlds;
  return worlds;
}

/// The link that this call of our function stands for, for as long as the call lasts.
class Call {
 public:
  explicit Call(Slot& slot) : slot_(slot) {
    if (slot.depth < slot.links.size()) link_ = slot.links[slot.links.size() - 1 - slot.depth];
    ++slot_.depth;
  }
  ~Call() { --slot_.depth; }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  [[nodiscard]] const Link& link() const { return link_; }

 private:
  Slot& slot_;
  Link link_;
};

void preTick(btDynamicsWorld* world, btScalar dt) {
  WorldSlots* slots = attachedWorlds().find(world);
  if (slots == nullptr) return;
  const Call call(slots->pre);
  if (call.link().below != nullptr) call.link().below(world, dt);
  if (call.link().listener != nullptr) call.link().listener->beforeHostStep(dt);
}

void postTick(btDynamicsWorld* world, btScalar dt) {
  WorldSlots* slots = attachedWorlds().find(world);
  if (slots == nullptr) return;
  const Call call(slots->post);
  if (call.link().listener != nullptr) call.link().listener->afterHostStep(dt);
  if (call.link().below != nullptr) call.link().below(world, dt);
}

/// Puts a link on top of the slot, or wakes our silent link if that is what stands there.
void attach(btDynamicsWorld& world, Slot& slot, btInternalTickCallback present,
            btInternalTickCallback ours, bool is_pre_tick, HostStepListener& listener) {
  if (present == ours && !slot.links.empty()) {
    slot.links.back().listener = &listener;
    return;
  }
  slot.links.push_back({present, &listener});
  world.setInternalTickCallback(ours, world.getWorldUserInfo(), is_pre_tick);
}

/// Puts back what was in the slot if we are on top, else leaves a silent link.
void detach(btDynamicsWorld& world, Slot& slot, btInternalTickCallback present,
            btInternalTickCallback ours, bool is_pre_tick) {
  for (Link& link : slot.links) link.listener = nullptr;
  if (present != ours || slot.links.empty()) return;
  world.setInternalTickCallback(slot.links.back().below, world.getWorldUserInfo(), is_pre_tick);
  slot.links.pop_back();
}

}  // namespace

HostWorld::HostWorld(btDiscreteDynamicsWorld& world, HostStepListener& listener, BulletAbi host)
    : world_(world) {
  checkBulletAbi(host);
  WorldSlots& slots = attachedWorlds().findOrAdd(&world);
  if (slots.pre.hasListener() || slots.post.hasListener()) {
    throw Error(
        "this Bullet world is attached already; use its existing HostWorld (or Site), or destroy "
        "that "
        "one first");
  }
  attach(world, slots.pre, TickSlots::preTick(world), preTick, true, listener);
  attach(world, slots.post, TickSlots::postTick(world), postTick, false, listener);
}

HostWorld::~HostWorld() {
  WorldSlots* slots = attachedWorlds().find(&world_);
  if (slots == nullptr) return;
  detach(world_, slots->pre, TickSlots::preTick(world_), preTick, true);
  detach(world_, slots->post, TickSlots::postTick(world_), postTick, false);
  if (slots->pre.links.empty() && slots->post.links.empty()) attachedWorlds().forget(&world_);
}

}  // namespace tandem
