#pragma once

#include <vector>

#include "bullet_bridge/src/surroundings/neighbours.h"
#include "bullet_bridge/src/surroundings/obstacles.h"
#include "site/host_forces.h"
#include "site/local_hand.h"
#include "site/neighbour.h"
#include "site/peers.h"

namespace tandem {

/// What is around the island's bodies in the host's world, looked at once per host step.
///
///   standing objects   searched for contact at each inner step (Obstacles)
///   moving bodies      the island holds them while they may take part in contact (Neighbour)
///
/// A neighbour comes with the state that the host has it in, at the host's time. Where the island
/// is ahead of that, all that come together are moved on together. When one goes back, it is paid
/// the momentum that its state in the host's world does not have yet.
///
/// The host's thread looks; what it finds acts when whoever ticks takes it:
///
///     host's thread    findMissing               giveBack  ...  look           giveBack
///     who ticks                     takeLeaving                        take
class Surroundings {
 public:
  Surroundings(btDiscreteDynamicsWorld& world, const SiteSettings& settings, Island& island,
               Timeline& timeline, const HostClock& clock, Bodies& bodies, Peers& peers,
               LocalHand& hand, HostForces& forces, SiteLog& log);

  /// @name Set-up.
  /// @{
  [[nodiscard]] ContactFinder& contactFinder() noexcept { return obstacles_; }
  /// Room for neighbours, in an island that holds them.
  void addSlots(int count);
  void addSphere(BodyIndex index, double radius) { obstacles_.addSphere(index, radius); }
  void addBody(BodyIndex index, btRigidBody& rigid) { obstacles_.addBody(index, rigid); }
  /// A body that is the island's anyway.
  void exclude(const btRigidBody& rigid) { search_.exclude(rigid); }
  /// Allocates.
  void makeRoom();
  /// @}

  [[nodiscard]] std::vector<Neighbour>& neighbours() noexcept { return neighbours_; }
  [[nodiscard]] int neighbourCount() const noexcept;

  /// @name For the thread that steps the host's world.
  /// @{
  /// Marks neighbours that the host has taken out of its world or made another body.
  void findMissing();
  /// Looks for what is near, for a host's step of `dt` that ends at `step_end` [s]. What the mirror
  /// says is up to `age` old [s]. `everywhere`: also around bodies that sleep with nothing awake
  /// near them, where it is else enough to look now and then.
  void look(double dt, double step_end, double age, bool everywhere = false);
  /// Until the host is heard again at the latest, after a step of `dt` [s].
  [[nodiscard]] double computeHorizon(double dt) const noexcept;
  /// True if springs may shoot a body farther than was looked.
  [[nodiscard]] bool mustLookFarther() const noexcept;
  void lookFarther();
  /// Bodies that were taken out of the island are the host's again.
  void giveBack();
  /// All neighbours leave.
  void leaveAll();
  void lookAtDamping() noexcept;
  /// Where the host's step that ends at `step_end` has taken, or will take, kinematic bodies.
  void lookAtDriven(double step_end) noexcept;
  [[nodiscard]] bool isAnythingDriven() const { return search_.isAnythingDriven(); }
  /// The host's world ends: nothing of it is near any more, after takeObstacles().
  void forgetWorld() { obstacles_.forgetWorld(); }
  /// @}

  /// @name For whoever ticks, while the host's thread waits. Real-time safe.
  /// @{
  /// The island as the host's thread will know it.
  void mirror() noexcept;
  /// Neighbours that leave are taken out, and what lookFarther() has found acts.
  void takeLeaving() noexcept;
  /// What look() has found acts from now on.
  void take() noexcept;
  /// What lookFarther() or forgetWorld() has found.
  void takeObstacles() noexcept;
  void followDamping() noexcept;
  /// Kinematic bodies go where the host's latest pose and velocity lead. `ticks_in_step`: the
  /// ticks of the step in which they were seen are still to come.
  void steerDriven(bool ticks_in_step) noexcept;
  /// @}

 private:
  /// What a search needs to know of the island.
  struct Mirror {
    std::vector<RigidState> states;  ///< by body
    std::vector<char> moves;         ///< by body, awake then
    double island_time = 0.0;

    void set(BodyIndex body, const RigidState& state, bool is_awake) noexcept;
    [[nodiscard]] double computeSpeed() const noexcept;
  };

  [[nodiscard]] std::size_t countHapticBodies() const noexcept;
  void lookForNeighbours(double horizon, double step_end, bool everywhere);
  void collectSeeds(bool everywhere);
  void searchObstacles(bool everywhere);
  [[nodiscard]] bool isTurnOfFullLook() noexcept;
  void promote(btRigidBody& rigid, Neighbour& neighbour, double step_end);
  void hold(btRigidBody& rigid, Neighbour& neighbour);
  void leave(Neighbour& neighbour);
  void takeOut(Neighbour& neighbour) noexcept;
  void takeNewcomers() noexcept;
  void catchUp() noexcept;
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
  NeighbourSearch search_;
  std::vector<Neighbour> neighbours_;  ///< one per slot of the island
  Mirror mirror_;
  std::vector<NeighbourSeed> seeds_;
  std::vector<Neighbour*> leaving_;  ///< gone, another body now, or not near any more
  int looks_to_full_ = 0;            ///< that may leave out who sleeps
  double horizon_ = 0.0;             ///< until the host is heard again at the latest [s]
  double way_by_springs_ = 0.0;      ///< that bodies may go besides what their speed takes them [m]
  double spring_speed_ = 0.0;        ///< that stretched springs may add to a body's [m/s]
  bool has_changed_ = false;         ///< what stands near is not what it was, since take()
  bool has_more_ = false;            ///< lookFarther() has found what does not act yet
  std::vector<BodyIndex> newcomers_;  ///< slots filled since they were caught up last
  std::vector<RigidState> from_states_, to_states_;
  std::vector<Aside> asides_;
};

}  // namespace tandem
