#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bullet_bridge/src/arms/world_joints.h"
#include "bullet_bridge/src/bodies/away_bodies.h"
#include "bullet_bridge/src/joints/moved_frames.h"
#include "bullet_bridge/src/surroundings/neighbours.h"
#include "bullet_bridge/src/surroundings/obstacles.h"
#include "site/host_forces.h"
#include "site/local_hand.h"
#include "site/neighbour.h"
#include "site/peers.h"

namespace tandem {

// clang-format off
/// Objects of the host's world around the island's bodies, searched once per host step.
///
///   standing objects  the island searches them for contact at each inner step (Obstacles)
///   moving bodies     the island holds them while they may take part in contact (Neighbour)
///
/// A neighbour enters with its state at the host's time. If the island is ahead, all newcomers are
/// moved on together. A neighbour that leaves receives the momentum that its host body still lacks.
///
/// The host's thread searches; the thread that ticks applies the results:
///
///     host's thread      findMissing               giveBack  ...  look           giveBack
///     thread that ticks               takeLeaving                       take
// clang-format on
class Surroundings {
 public:
  Surroundings(btDiscreteDynamicsWorld& world, const SiteSettings& settings, Island& island,
               Timeline& timeline, const HostClock& clock, Bodies& bodies, Peers& peers,
               LocalHand& hand, HostForces& forces, SiteLog& log);

  /// @name Set-up.
  /// @{
  [[nodiscard]] ContactFinder& contactFinder() noexcept { return obstacles_; }
  [[nodiscard]] WorldJoints& joints() noexcept { return joints_; }
  /// Adds slots for neighbours to the island.
  void addSlots(int count);
  void addSphere(BodyIndex index, double radius) { obstacles_.addSphere(index, radius); }
  void addBody(BodyIndex index, btRigidBody& rigid) { obstacles_.addBody(index, rigid); }
  /// Excludes a body that the island holds whenever it can.
  void exclude(const btRigidBody& rigid) { search_.exclude(rigid); }
  /// Forgets an excluded body that was deleted: another may be made at its address.
  void forgetExcluded(const btRigidBody* rigid) noexcept { search_.include(rigid); }
  /// Allocates.
  void makeRoom();
  /// @}

  /// @name For a shared object that leaves the island or comes back.
  /// @{
  /// In the host's thread. Meanwhile it may be a neighbour or an obstacle like any body.
  /// `is_present`: it is in the host's world.
  void releaseBody(BodyIndex index, btRigidBody& rigid, bool is_present);
  void holdBody(BodyIndex index, btRigidBody& rigid, const RigidState& start);
  [[nodiscard]] bool isNeighbour(const btRigidBody& rigid) const noexcept;
  /// In the thread that ticks, after the island was filled: it catches up with the island's time.
  void addNewcomer(BodyIndex index) noexcept { newcomers_.push_back(index); }
  /// Newcomers start with their state at the host's time; the island may be ahead of it.
  void catchUp() noexcept;
  /// @}

  [[nodiscard]] std::vector<Neighbour>& neighbours() noexcept { return neighbours_; }
  [[nodiscard]] int neighbourCount() const noexcept;

  /// @name For the thread that steps the host's world.
  /// @{
  /// Finds joints whose frames the host moved, before its step of `dt` [s].
  void lookAtFrames(double dt) { moved_frames_.look(dt); }
  /// True if such a joint drags the body.
  [[nodiscard]] bool isDragged(const btRigidBody& rigid) const noexcept {
    return moved_frames_.isDragged(rigid);
  }
  /// Marks neighbours that the host removed from its world, drags or changed into another body.
  void findMissing();
  /// Searches around the bodies for a host step of `dt` that ends at `step_end` [s]. The mirror is
  /// up to `age` old [s]. `everywhere`: also around parked bodies with nothing awake near them,
  /// which are otherwise searched less often.
  void look(double dt, double step_end, double age, bool everywhere = false);
  /// The next searches expect a body there: it is put elsewhere.
  void expectAt(BodyIndex body, const RigidState& state) noexcept {
    mirror_.set(body, state, true);
  }
  /// True if the host changed an object that may be touched since the last search for them, or a
  /// body has left the island since the last call: it may stand now.
  [[nodiscard]] bool hasNews() { return std::exchange(has_left_, false) || obstacles_.hasNews(); }
  /// Searches for standing objects; `everywhere` as in look().
  void searchObstacles(bool everywhere);
  /// The host has moved all of its world by `offset_W` [m]; the thread that ticks waits.
  void shiftOrigin(const Vec3& offset_W) noexcept;
  /// Longest time until the host's next search, after a step of `dt` [s].
  [[nodiscard]] double computeHorizon(double dt) const noexcept;
  /// True if springs may move a body beyond the searched range.
  [[nodiscard]] bool mustLookFarther() const noexcept;
  void lookFarther();
  /// Gives bodies that left the island back to the host.
  void giveBack();
  /// All neighbours leave.
  void leaveAll();
  void lookAtDamping() noexcept;
  /// Around those of single bodies: what concerns all links of a multi-body at once (HostArm).
  /// @{
  void lookAtArms(double dt) noexcept;
  void handOffArms(double dt) noexcept;
  void restoreArms() noexcept;
  void placeArms() noexcept;
  /// @}
  /// Reads the poses of kinematic bodies for the host's step that ends at `step_end` [s].
  void lookAtDriven(double step_end) noexcept;
  /// False: look() takes no neighbours.
  void holdNeighbours(bool holds) noexcept { holds_neighbours_ = holds; }
  /// True if the pose of a body must be read in each step, although nothing moves now.
  [[nodiscard]] bool isAnythingDriven() const;
  /// True if a body that the last look() did not find comes to the hand. Meanwhile the hand rests.
  [[nodiscard]] bool isAnythingComing() const;
  /// True if joints of a shared body act at the host's rate only, as the island cannot hold them.
  [[nodiscard]] bool leavesJointsOf(const btRigidBody& rigid) const {
    return search_.leavesJointsOf(rigid);
  }
  /// Adds lines about multi-bodies that the island cannot hold, and contact that stays Bullet's.
  void explain(std::vector<std::string>& lines) const;
  /// True if a moving object that the island does not hold may touch the body within `horizon` [s].
  [[nodiscard]] bool isStrangerNear(const SiteBody& body, double horizon) const {
    const HapticBody* rigid = body.bullet->asRigid();
    return rigid && search_.isStrangerNear(rigid->body(), horizon);
  }
  /// Around Bullet's step, which must not see the contacts that are shown to the host.
  void hideContacts() noexcept { obstacles_.hideContacts(); }
  void unhideContacts() { obstacles_.unhideContacts(); }
  /// In between: what takeContacts() told.
  void showContacts() { obstacles_.showContacts(contacts_, still_); }
  /// The host's world ends: takeObstacles() then removes all obstacles.
  void forgetWorld() {
    obstacles_.forgetWorld();
    joints_.forgetWorld();
    moved_frames_.forget();
    away_.clear();
  }
  /// Gives a body of the host back what is its own, as soon as it is in the world.
  void release(std::unique_ptr<HapticBody> body) noexcept { away_.release(std::move(body)); }
  void restoreReturned() noexcept { away_.restoreReturned(); }
  /// True if a body that was away may be back.
  [[nodiscard]] bool mayBodiesBeBack() const noexcept { return away_.mayBeBack(); }
  /// @}

  /// @name For the thread that ticks, while the host's thread waits. Real-time safe.
  /// @{
  /// Copies the island's states for the host's thread.
  void mirror() noexcept;
  /// Copies the rigid contacts of the host's step for the host's thread.
  void takeContacts() noexcept;
  /// Removes leaving neighbours and applies the results of lookFarther().
  void takeLeaving() noexcept;
  /// Applies the results of look().
  void take() noexcept;
  /// Applies the results of lookFarther() or forgetWorld().
  void takeObstacles() noexcept;
  void followDamping() noexcept;
  /// Steers kinematic bodies along the host's latest pose and velocity. `ticks_in_step`: the ticks
  /// of the step in which they were read have not run yet.
  void steerDriven(bool ticks_in_step) noexcept;
  /// @}

 private:
  /// Copy of the island for searches.
  struct Mirror {
    std::vector<RigidState> states;  ///< by body
    std::vector<char> moves;         ///< by body: awake at the copy
    double island_time = 0.0;
    double depth = 0.0;  ///< Island::deepestTouch() [m]

    void set(BodyIndex body, const RigidState& state, bool is_awake) noexcept;
    [[nodiscard]] double computeSpeed() const noexcept;
  };

  /// True if nothing is shared and nobody is connected.
  [[nodiscard]] bool isHandAlone() const noexcept;
  [[nodiscard]] bool takesNeighbours() const noexcept;
  [[nodiscard]] NeighbourSeed makeHandSeed(const RigidState& state, double radius) const;
  [[nodiscard]] std::size_t countHapticBodies() const noexcept;
  void lookForNeighbours(double horizon, double step_end, bool everywhere);
  void lookForJoints();
  [[nodiscard]] std::optional<BodyIndex> findHeld(const btRigidBody& rigid) const noexcept;
  void takeJoints() noexcept;
  void collectSeeds(bool everywhere);
  [[nodiscard]] bool isTurnOfFullLook() noexcept;
  void promote(btRigidBody& rigid, Neighbour& neighbour, double step_end);
  void promoteArm(btMultiBody& arm);
  void setContact(Neighbour& neighbour, btCollisionObject& collider);
  void leaveArm(const HostArm& arm);
  [[nodiscard]] bool isLeaving(const HostArm& arm) const noexcept;
  [[nodiscard]] bool isActing(const HostArm& arm) const noexcept;
  [[nodiscard]] Neighbour* findEmpty() noexcept;
  void hold(btRigidBody& rigid, Neighbour& neighbour);
  void filterProxies(btCollisionObject& object, bool is_present, bool is_held);
  void leave(Neighbour& neighbour);
  void takeOut(Neighbour& neighbour) noexcept;
  void takeNewcomers() noexcept;
  void readStates(double time, std::vector<RigidState>& states) noexcept;
  [[nodiscard]] double computeSpeedInSprings() const noexcept;

  btDiscreteDynamicsWorld& world_;
  const SiteSettings& settings_;
  Island& island_;
  Timeline& timeline_;
  const HostClock& clock_;
  Bodies& bodies_;
  Peers& peers_;
  LocalHand& hand_;
  HostForces& forces_;
  SiteLog& log_;

  Obstacles obstacles_;
  AwayBodies away_;
  MovedFrames moved_frames_;
  NeighbourSearch search_;
  WorldJoints joints_;
  std::vector<std::unique_ptr<HostArm>> arms_;  ///< that the island holds, or will
  std::vector<Neighbour> neighbours_;           ///< one per slot of the island
  Mirror mirror_;
  std::vector<NeighbourSeed> seeds_;
  std::vector<ArmJoints::Member> members_;
  std::vector<ContactSum> contacts_;  ///< of the last host step
  std::vector<char> still_;           ///< by body: nothing moves it
  std::vector<Neighbour*> leaving_;   ///< removed, changed, or no longer near
  int looks_to_full_ = 0;             ///< looks until the next one around all bodies
  double horizon_ = 0.0;              ///< longest time until the next search [s]
  double way_by_springs_ = 0.0;       ///< extra motion of bodies by springs [m]
  double spring_speed_ = 0.0;         ///< speed that stretched springs may add [m/s]
  bool holds_neighbours_ = true;      ///< false: not before the first tick
  bool has_left_ = false;             ///< a body has left since hasNews()
  bool has_changed_ = false;          ///< obstacles changed since take()
  bool has_more_ = false;             ///< results of lookFarther() do not act yet
  std::vector<BodyIndex> newcomers_;  ///< slots filled since the last catch-up
  std::vector<RigidState> from_states_, to_states_;
  std::vector<Aside> asides_;
};

}  // namespace tandem
