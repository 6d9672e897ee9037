#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bench/account/island_watch.h"
#include "bench/stress/stress_case.h"

namespace tandem::demos::bench {

/// One site of a case with its world, its device, and the account of its island.
class StressSite {
 public:
  /// `self` is the index of its user among the case's users. `links` go to the other users, in
  /// order, and must outlive the site; scripts have none. Throws the exceptions of Site.
  StressSite(const StressCase& one, std::size_t self, const std::vector<Link*>& links);
  ~StressSite();
  StressSite(const StressSite&) = delete;
  StressSite& operator=(const StressSite&) = delete;

  /// Runs one haptic tick, and the host's steps that end in it.
  void tick(std::uint64_t tick);

  [[nodiscard]] const EnergyAccount& account() const { return *account_; }
  [[nodiscard]] EnergyAccount& account() { return *account_; }
  [[nodiscard]] const Island& island() const { return *watch_.island(); }
  [[nodiscard]] Site& site() { return *site_; }
  /// True if the site's state, its force and all of the world's bodies are finite.
  [[nodiscard]] bool isFinite() const;
  /// Largest distance so far of a joint's two points in the host's world, after its steps [m]. No
  /// longer measured once a link has turned by more than 0.3 rad in an inner step.
  [[nodiscard]] double pinGap() const { return pin_gap_; }
  /// Kinetic energy of a simulated device [J], and the hand's energy input without what it took
  /// back.
  [[nodiscard]] double deviceEnergy() const;
  [[nodiscard]] double handWork() const { return hand_work_; }
  /// Position of a simulated device at the start of the latest tick.
  [[nodiscard]] Vec3 tickHandle() const {
    return site_->hip().p_W - site_->hip().v_W / case_.haptic_rate;
  }

 private:
  void makeDevice();
  [[nodiscard]] double findRigidOverlap();
  void connect(const std::vector<Link*>& links);
  [[nodiscard]] SiteSettings makeSettings() const;
  void addBody(const StressBody& body);
  void addJoint(const StressJoint& joint);
  [[nodiscard]] bool spinsWildly() const;
  [[nodiscard]] double measurePins() const;

  const StressCase& case_;
  const StressUser& user_;
  std::size_t self_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::unique_ptr<HapticDevice> device_;
  const SimulatedDevice* simulated_ = nullptr;
  IslandWatch watch_;
  AccountScene scene_;
  std::vector<std::unique_ptr<Link>> links_;
  std::unique_ptr<Site> site_;
  std::unique_ptr<EnergyAccount> account_;
  Vec3 handle_W_ = Vec3::Zero();
  double hand_work_ = 0.0;
  double pin_gap_ = 0.0;
  bool measures_pins_ = true;
  std::uint64_t host_steps_ = 0;
};

}  // namespace tandem::demos::bench
