#pragma once

#include <memory>
#include <vector>

#include "tandem/plugin/site_settings.h"

#include "bullet_bridge/src/native/native_coupling.h"
#include "coordination/src/island/island.h"

namespace tandem {

class HapticBody;
class SphereBody;

/// Contact and couplers by Bullet's own means, in the host's world and at the host's rate. The
/// island moves nothing: it keeps the states and targets that the site's tick reads and writes.
///
/// The local hand is a kinematic sphere. With soft contact the spheres carry the gains and other
/// bodies are rigid. Two soft spheres would act in series, so the hand carries gains only once an
/// object is shared.
class NativeModel {
 public:
  NativeModel(btDiscreteDynamicsWorld& world, const SiteSettings& settings, const Vec3& hand_W);
  /// Switches the damping of objects off again, as HapticBody sets it, and lets them sleep.
  ~NativeModel();
  NativeModel(const NativeModel&) = delete;
  NativeModel& operator=(const NativeModel&) = delete;

  /// Set-up, once for each body; may throw std::invalid_argument. Objects must outlive this. So
  /// must rigid bodies with joints or guides, and all others until they leave the world.
  void addObject(const HapticBody& object, double damping);
  void addProxy(BodyIndex body, const SphereBody& proxy, const StandInSettings& stand_in);
  /// Adds a prescribed proxy: a kinematic sphere held at the state of `body`.
  KinematicSphere& addHeldProxy(BodyIndex body, const Vec3& p_W, const StandInSettings& stand_in);
  /// Adds the counterpart of the island's coupler `index`, with its target.
  void addCoupler(btRigidBody& body, CouplerIndex index, CouplerSettings coupler);

  /// False once the hand or a held proxy was removed from the world.
  [[nodiscard]] bool isPresent() const noexcept;

  /// Pre-tick: takes over the island's shares of couplers, contacts and damping. Rigid contact has
  /// no gain to scale.
  void followShares(const Island& island) noexcept;

  /// Pre-tick and post-tick of a host step of dt [s], in which the hand moves to `hand_end_W`.
  void beginStep(const Island& island, const Vec3& hand_end_W, double dt) noexcept;
  void endStep(double dt) noexcept;

  /// Contact force on the hand, in W [N]: the impulses of the latest host step divided by its
  /// length.
  [[nodiscard]] const Vec3& handForce() const noexcept { return hand_force_W_; }

 private:
  /// A shared body: it never sleeps, as nothing hands it off.
  struct Object {
    const HapticBody* bullet;
    bool may_sleep;  ///< with its host's activation state
  };
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
  std::vector<Object> objects_;
};

}  // namespace tandem
