#include "world/world_end_watch.h"

#include <new>
#include <tuple>
#include <typeinfo>

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btSimulationIslandManagerMt.h>

namespace tandem {

class IslandManagerStandIn {
 public:
  explicit IslandManagerStandIn(WorldEndWatch& watch) : watch_(&watch) {}
  virtual ~IslandManagerStandIn() = default;
  IslandManagerStandIn(const IslandManagerStandIn&) = delete;
  IslandManagerStandIn& operator=(const IslandManagerStandIn&) = delete;

  /// Restores the world's own manager and frees this; if that is impossible, stays and is silent.
  virtual void leave(btDiscreteDynamicsWorld& world) noexcept = 0;

 protected:
  void fallSilent() noexcept { watch_ = nullptr; }
  void tellEnd() noexcept {
    if (watch_ == nullptr) return;
    watch_->stand_in_ = nullptr;
    watch_->listener_.worldEnds();
  }

 private:
  WorldEndWatch* watch_;
};

namespace {

/// Accesses Bullet's protected members. Naming a protected member through a derived class is legal
/// C++; nothing is cast.
struct ManagerSlot : btDiscreteDynamicsWorld {
  static btSimulationIslandManager*& of(btDiscreteDynamicsWorld& world) {
    return world.*(&ManagerSlot::m_islandManager);
  }
  static bool isOwned(btDiscreteDynamicsWorld& world) {
    return world.*(&ManagerSlot::m_ownsIslandManager);
  }
};

/// Settings of a manager that a host may change; all its other data lasts one step.
bool readSettings(btSimulationIslandManager& manager) { return manager.getSplitIslands(); }
void writeSettings(btSimulationIslandManager& manager, bool splits) {
  manager.setSplitIslands(splits);
}
using MtSettings = std::tuple<bool, int, btSimulationIslandManagerMt::IslandDispatchFunc>;
MtSettings readSettings(btSimulationIslandManagerMt& manager) {
  return {manager.getSplitIslands(), manager.getMinimumSolverBatchSize(),
          manager.getIslandDispatchFunction()};
}
void writeSettings(btSimulationIslandManagerMt& manager, const MtSettings& settings) {
  manager.setSplitIslands(std::get<0>(settings));
  manager.setMinimumSolverBatchSize(std::get<1>(settings));
  manager.setIslandDispatchFunction(std::get<2>(settings));
}

/// `Manager` is the first base: the world frees the memory at that address.
template <typename Manager>
class StandIn final : public Manager, public IslandManagerStandIn {
 public:
  StandIn(WorldEndWatch& watch, Manager& original)
      : IslandManagerStandIn(watch), original_(&original), known_(readSettings(original)) {
    writeSettings(own(), known_);
  }
  ~StandIn() override {
    if (original_ == nullptr) return;
    tellEnd();
    original_->~Manager();
    btAlignedFree(original_);
  }

  void leave(btDiscreteDynamicsWorld& world) noexcept override {
    btSimulationIslandManager*& place = ManagerSlot::of(world);
    if (place != &own()) return fallSilent();
    followSettings();
    place = original_;
    original_ = nullptr;
    this->~StandIn();
    btAlignedFree(static_cast<btSimulationIslandManager*>(this));
  }

  /// The first call of each step.
  void updateActivationState(btCollisionWorld* world, btDispatcher* dispatcher) override {
    followSettings();
    Manager::updateActivationState(world, dispatcher);
  }

 private:
  Manager& own() noexcept { return *this; }

  /// Syncs the settings: the host may change them here or in the original manager it still knows.
  void followSettings() {
    const auto theirs = readSettings(*original_);
    known_ = theirs != known_ ? theirs : readSettings(own());
    writeSettings(own(), known_);
    writeSettings(*original_, known_);
  }

  Manager* original_;
  decltype(readSettings(std::declval<Manager&>())) known_;
};

template <typename Manager>
IslandManagerStandIn* standIn(WorldEndWatch& watch, btSimulationIslandManager*& place) {
  void* memory = btAlignedAlloc(sizeof(StandIn<Manager>), 16);
  auto* stand_in = new (memory) StandIn<Manager>(watch, static_cast<Manager&>(*place));
  place = stand_in;
  return stand_in;
}

}  // namespace

WorldEndWatch::WorldEndWatch(btDiscreteDynamicsWorld& world, WorldEndListener& listener)
    : world_(world), listener_(listener) {
  btSimulationIslandManager*& place = ManagerSlot::of(world);
  if (!ManagerSlot::isOwned(world) || place == nullptr) return;
  const std::type_info& type = typeid(*place);
  if (type == typeid(btSimulationIslandManager)) {
    stand_in_ = standIn<btSimulationIslandManager>(*this, place);
  } else if (type == typeid(btSimulationIslandManagerMt)) {
    stand_in_ = standIn<btSimulationIslandManagerMt>(*this, place);
  }
}

WorldEndWatch::~WorldEndWatch() {
  if (stand_in_ != nullptr) stand_in_->leave(world_);
}

}  // namespace tandem
