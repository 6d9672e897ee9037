#pragma once

#include "tandem/plugin/site.h"

#include "site/host_step.h"
#include "site/site_parts.h"

namespace tandem {

// clang-format off
/// A site: its parts, and the strategy by which host steps and ticks move the bodies.
///
///     tick        device sample -> packets -> force -> device; then the island moves on
///     host step   the host's changes -> island -> Bullet -> its solver's impulses -> island
// clang-format on
struct Site::Impl final : HostStepListener, SiteParts {
  Impl(const SiteSettings& settings, btDiscreteDynamicsWorld& world, HapticDevice& device,
       BulletAbi abi);
  ~Impl() override;

  // Set-up: site_set_up.cpp
  ObjectId share(btRigidBody& rigid, double damping);
  std::vector<ObjectId> share(const std::vector<NamedBody>& named);
  void share(ObjectId id, btRigidBody& rigid);
  ObjectId shareTool(btRigidBody& rigid, PeerId user, const Vec3& at_B);
  void unshare(ObjectId id);
  void connect(PeerId id, Link& link, const Vec3& start_W);
  /// A haptic thread ticks from now on.
  void beginLive();

  // At any time between two host steps: site_grip.cpp
  void grab(ObjectId id, const std::optional<Vec3>& at_B);
  void release() noexcept;
  // site_origin.cpp
  void shiftOrigin(const Vec3& offset_W);

  // The tick: site_tick.cpp
  std::uint32_t tick(double now, double most_made_up) noexcept override;

  // The host's step and the end of its world: site_host.cpp
  void beforeHostStep(double dt) noexcept override;
  void afterHostStep(double dt) noexcept override;
  void hostWorldEnds() noexcept override;

  [[nodiscard]] std::vector<std::string> warnings() const;

  std::unique_ptr<HostStep> host_step;

 private:
  ObjectId add(SharedObject object, btRigidBody& rigid);
  static void checkPlace(const Vec3& at_B);
  void checkCanHold() const;
  void checkOpenToSetUp();
  SharedObject& findObject(ObjectId id);
  void checkShareable(const btRigidBody& rigid) const;
  void tieObjects();
  void finishSetUp();
  void listBodies();
  void begin(double now) noexcept;
  void keepLastLook();
  void giveBack(bool world_ends);

  bool has_given_back_ = false;  ///< the host's bodies are Bullet's for good
};

}  // namespace tandem
