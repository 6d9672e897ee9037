#pragma once

#include <string>
#include <vector>

#include "site/host_forces.h"
#include "site/local_hand.h"
#include "site/peers.h"
#include "site/surroundings.h"

class btDiscreteDynamicsWorld;

namespace tandem {

// clang-format off
/// Leaves a shared object to Bullet while the island cannot hold it, and holds it again afterwards:
///
///   taken out of its world        its state is not sent; peers let go of their copies' ties
///   pinned, led, switched off     Bullet moves it; its state is sent, so that peers follow
///   dragged by a moved joint      the same, until the joint's frames have stood for a while
///   another mass or shape         held again at once as it is now, or after Bullet's step if it
///                                 changed in that
///
/// An object that is held again starts without forces of peers. They begin with their next state.
///
///     host's thread      findChanged               giveBack  findReturned
///     thread that ticks               takeLeaving                          take
// clang-format on
class ObjectWatch {
 public:
  ObjectWatch(btDiscreteDynamicsWorld& world, Island& island, Timeline& timeline, Bodies& bodies,
              Peers& peers, LocalHand& hand, HostForces& forces, Surroundings& surroundings,
              SiteLog& log)
      : world_(world),
        island_(island),
        timeline_(timeline),
        bodies_(bodies),
        peers_(peers),
        hand_(hand),
        forces_(forces),
        surroundings_(surroundings),
        log_(log) {}

  /// @name For the thread that steps the host's world.
  /// @{
  /// Marks the objects that the island must leave, and proxies that the host has taken out. True if
  /// an object must leave.
  bool findChanged();
  /// Marks all objects.
  void leaveAll();
  /// Marks an object if it is held. forget() follows when it was given back.
  void leaveOne(SharedObject& object);
  /// Lets go of the body of an object that is not held: it never returns.
  void forget(SharedObject& object) noexcept;
  /// Expects `rigid` for an object that has no body. findReturned() holds it.
  void expect(SharedObject& object, btRigidBody& rigid) noexcept;
  /// True if some object is marked, and not given back yet.
  [[nodiscard]] bool areLeaving() const noexcept { return are_leaving_; }
  /// True if some object is left to Bullet.
  [[nodiscard]] bool hasLeft() const noexcept { return left_ > 0; }
  /// Reads Bullet's states of objects that are left to it, and holds those again that may be held.
  /// True if there are any. May allocate.
  bool findReturned();
  /// Gives objects that left the island back to the host, in its step unless told otherwise.
  void giveBack(bool is_between_steps = false);
  /// Adds a line for each object that is missing or left to Bullet.
  void explain(std::vector<std::string>& lines) const;
  /// @}

  /// @name For the thread that ticks, while the host's thread waits. Real-time safe.
  /// @{
  void takeLeaving() noexcept;
  /// Applies the results of findReturned(), in the host's step of `dt` [s].
  void take(double dt) noexcept;
  /// @}

 private:
  [[nodiscard]] bool mayHold(const SharedObject& object) const noexcept;
  void leave(SharedObject& object);
  bool hold(SharedObject& object);
  void notePlace(SharedObject& object, const RigidState& now, double dt) noexcept;

  btDiscreteDynamicsWorld& world_;
  Island& island_;
  Timeline& timeline_;
  Bodies& bodies_;
  Peers& peers_;
  LocalHand& hand_;
  HostForces& forces_;
  Surroundings& surroundings_;
  SiteLog& log_;
  bool are_leaving_ = false;
  int left_ = 0;  ///< objects that the island does not hold, and that may return
};

}  // namespace tandem
