#include "world/host_world.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/coordination/types.h"

#include "world/world_end_watch.h"

// clang-format off
//   Bullet ─► [another layer ─►] our tick ─► the callback that was in the slot before us
//
// Bullet's callbacks receive only the world (the user pointer is the host's), so a table maps the
// world to our state. If another layer sits on top of our detached link and somebody attaches
// again, our function is twice in one chain. The outermost call is then the newest link. Links
// change only while none of them is being called. A link detached within a step is silent at once,
// and removed at the end of the call.
// clang-format on

namespace tandem {
namespace {

/// Reads Bullet's protected callbacks. Naming a protected member through a derived class is legal
/// C++; nothing is cast.
struct TickSlots : btDynamicsWorld {
  static btInternalTickCallback preTick(const btDynamicsWorld& world) {
    return world.*(&TickSlots::m_internalPreTickCallback);
  }
  static btInternalTickCallback postTick(const btDynamicsWorld& world) {
    return world.*(&TickSlots::m_internalTickCallback);
  }
};

/// One place of our tick function in a slot's chain.
struct ChainEntry {
  btInternalTickCallback below = nullptr;  // callback in the slot before us
  HostStepListener* listener = nullptr;    // null: detached, only calls through
};

/// Our links in one slot of one world, oldest first, and the number of calls now active.
struct Slot {
  std::vector<ChainEntry> links;
  std::size_t depth = 0;
  std::size_t called = 0;  // number of links when the outermost call began

  [[nodiscard]] bool hasListener() const {
    for (const ChainEntry& link : links) {
      if (link.listener != nullptr) return true;
    }
    return false;
  }
  [[nodiscard]] bool isUnused() const { return links.empty() && depth == 0; }
};

struct WorldSlots {
  Slot pre;
  Slot post;
  HostStepListener* begun = nullptr;  // listener that was told of the present step
  bool is_left = false;               // no listener, but our links may remain
};

/// All attached worlds of the process. A lock guards the table; each entry belongs to its world's
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
  /// A thread's last result, valid until the table changes.
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
  // Never destroyed: static worlds may still step while the process ends.
  static AttachedWorlds& worlds = *new AttachedWorlds;
  return worlds;
}

/// The link of the present call of our function, for the time of the call.
class Call {
 public:
  explicit Call(Slot& slot) : slot_(slot) {
    if (slot.depth == 0) slot.called = slot.links.size();
    ++slot_.depth;
    place_ = slot.called - slot.depth;  // wraps to no link
  }
  ~Call() { --slot_.depth; }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// Read anew: a callback in between may detach us.
  [[nodiscard]] ChainEntry link() const {
    return place_ < slot_.links.size() ? slot_.links[place_] : ChainEntry{};
  }

 private:
  Slot& slot_;
  std::size_t place_;
};

void preTick(btDynamicsWorld* world, btScalar dt);
void postTick(btDynamicsWorld* world, btScalar dt);

/// Restores the callbacks below our silent links, while these are on top.
void removeSilent(btDynamicsWorld& world, Slot& slot, bool is_pre_tick) {
  const auto present = [&] {
    return is_pre_tick ? TickSlots::preTick(world) : TickSlots::postTick(world);
  };
  const btInternalTickCallback ours = is_pre_tick ? preTick : postTick;
  while (slot.depth == 0 && !slot.links.empty() && slot.links.back().listener == nullptr &&
         present() == ours) {
    world.setInternalTickCallback(slot.links.back().below, world.getWorldUserInfo(), is_pre_tick);
    slot.links.pop_back();
  }
}

void tidyUp(btDynamicsWorld& world, WorldSlots& slots) {
  removeSilent(world, slots.pre, true);
  removeSilent(world, slots.post, false);
  if (slots.pre.isUnused() && slots.post.isUnused()) attachedWorlds().forget(&world);
}

void preTick(btDynamicsWorld* world, btScalar dt) {
  WorldSlots* slots = attachedWorlds().find(world);
  if (slots == nullptr) return;
  {
    const Call call(slots->pre);
    ChainEntry link = call.link();
    if (link.below != nullptr) {
      link.below(world, dt);
      link = call.link();
    }
    if (link.listener != nullptr) {
      slots->begun = link.listener;
      link.listener->beforeHostStep(dt);
    }
  }
  if (slots->is_left) tidyUp(*world, *slots);
}

void postTick(btDynamicsWorld* world, btScalar dt) {
  WorldSlots* slots = attachedWorlds().find(world);
  if (slots == nullptr) return;
  {
    const Call call(slots->post);
    const ChainEntry link = call.link();
    if (link.listener != nullptr && link.listener == slots->begun) {
      slots->begun = nullptr;
      link.listener->afterHostStep(dt);
    }
    if (link.below != nullptr) link.below(world, dt);
  }
  if (slots->is_left) tidyUp(*world, *slots);
}

/// Puts a link on top of the slot, or wakes our silent link if it is on top.
void attach(btDiscreteDynamicsWorld& world, Slot& slot, btInternalTickCallback present,
            btInternalTickCallback ours, bool is_pre_tick, HostStepListener& listener) {
  if (present == ours && !slot.links.empty()) {
    slot.links.back().listener = &listener;
    return;
  }
  slot.links.push_back({present, &listener});
  world.setInternalTickCallback(ours, world.getWorldUserInfo(), is_pre_tick);
}

}  // namespace

struct HostWorld::Impl final : WorldEndListener {
  Impl(btDiscreteDynamicsWorld& host, HostStepListener& own)
      : world(host), listener(own), end_watch(host, *this) {}

  void worldEnds() noexcept override {
    has_ended = true;
    listener.hostWorldEnds();
    attachedWorlds().forget(&world);
  }

  btDiscreteDynamicsWorld& world;
  HostStepListener& listener;
  WorldEndWatch end_watch;
  bool has_ended = false;
};

HostWorld::HostWorld(btDiscreteDynamicsWorld& world, HostStepListener& listener, BulletAbi host)
    : world_(world) {
  checkBulletAbi(host);
  WorldSlots& slots = attachedWorlds().findOrAdd(&world);
  if (slots.pre.hasListener() || slots.post.hasListener()) {
    throw Error(
        "this Bullet world is attached already; use its existing HostWorld (or Site), or destroy "
        "that one first");
  }
  impl_ = std::make_unique<Impl>(world, listener);
  slots.is_left = false;
  attach(world, slots.pre, TickSlots::preTick(world), preTick, true, listener);
  attach(world, slots.post, TickSlots::postTick(world), postTick, false, listener);
}

HostWorld::~HostWorld() {
  if (impl_->has_ended) return;
  WorldSlots* slots = attachedWorlds().find(&world_);
  if (slots == nullptr) return;
  for (Slot* slot : {&slots->pre, &slots->post})
    for (ChainEntry& link : slot->links) link.listener = nullptr;
  slots->begun = nullptr;
  slots->is_left = true;
  tidyUp(world_, *slots);
}

bool HostWorld::hasEnded() const noexcept { return impl_->has_ended; }

std::vector<std::string> HostWorld::warnings() const {
  if (impl_->has_ended)
    return {
        "the Bullet world was destroyed before what was attached to it: nothing moves any more; "
        "destroy a Site before its world"};
  if (!impl_->end_watch.isWatching())
    return {
        "the world has an island manager of its own making, so its end cannot be noticed: destroy "
        "the Site before its world"};
  return {};
}

}  // namespace tandem
