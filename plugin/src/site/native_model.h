#pragma once

#include <memory>
#include <vector>

#include "tandem/plugin/site_settings.h"

#include "bullet_bridge/src/native/native_coupling.h"
#include "coordination/src/island/island.h"

namespace tandem {

class HapticBody;
class SphereBody;

/// A site's contact and couplers by what Bullet itself offers, in the host's own world and at the
/// host's rate. The island then moves nothing: it keeps the states and targets that the site's tick
/// reads and writes.
///
/// The local hand is a kinematic sphere. With soft contact the spheres carry the gains and what
/// they touch is rigid. Two spheres would be in series, so the hand carries only where it has
/// something else to touch: a shared object.
class NativeModel {
 public:
  NativeModel(btDiscreteDynamicsWorld& world, const SiteSettings& settings, const Vec3& hand_W);
  /// The damping of objects is off again, as HapticBody has it.
  ~NativeModel();
  NativeModel(const NativeModel&) = delete;
  NativeModel& operator=(const NativeModel&) = delete;

  /// Set-up, once for each thing; may throw std::invalid_argument. Objects must outlive this; their
  /// rigid bodies too unless they have left the world, but with joints and guides.
  void addObject(const HapticBody& object, double damping);
  void addProxy(BodyIndex body, const SphereBody& proxy);
  /// A proxy that is what it was told: a kinematic sphere that stands at the state of `body`.
  KinematicSphere& addHeldProxy(BodyIndex body, const Vec3& p_W);
  /// The counterpart of the island's coupler `index`, with its target.
  void addCoupler(btRigidBody& body, CouplerIndex index, CouplerSettings coupler);

  /// False once somebody has taken the hand or a held proxy out of the world.
  [[nodiscard]] bool isPresent() const noexcept;

  /// Pre-tick: takes over the shares of couplers, contacts and damping that the island has. Rigid
  /// contact has no gain to take a share of.
  void followShares(const Island& island) noexcept;

  /// Pre-tick and post-tick of a host step of dt [s], over which the hand moves to `hand_end_W`.
  void beginStep(const Island& island, const Vec3& hand_end_W, double dt) noexcept;
  void endStep(double dt) noexcept;

  /// Contact force on the hand: the impulses of the latest host step over its length, in W [N].
  [[nodiscard]] const Vec3& handForce() const noexcept { return hand_force_W_; }

 private:
  struct Held {
    BodyIndex body;
    std::unique_ptr<KinematicSphere> sphere;
  };
  struct Proxy {
    BodyIndex body;
    btRigidBody* rigid;
  };
  struct Coupled {
    CouplerIndex index;
    std::unique_ptr<NativeCoupler> coupler;
  };

  void guide(btRigidBody& body);
  void soften(btRigidBody& sphere, double share = 1.0) const;

  btDiscreteDynamicsWorld& world_;
  SiteSettings settings_;
  KinematicSphere hand_;
  std::vector<Held> held_;
  std::vector<Proxy> proxies_;
  std::vector<Coupled> couplers_;
  std::vector<std::unique_ptr<NativeGuide>> guides_;
  Vec3 hand_force_W_ = Vec3::Zero();
  std::vector<const HapticBody*> objects_;
};

}  // namespace tandem
