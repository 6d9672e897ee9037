#pragma once

#include <memory>

#include "site/host_step.h"
#include "site/native_model.h"
#include "site/site_parts.h"

namespace tandem {

// clang-format off
/// Bullet moves the bodies, with its own contact and couplers. The island keeps the states and
/// targets that ticks read and write.
///
///   pre-tick    the hand's sphere gets its path over this step; held proxies and couplers get the
///               states that packets brought
///   Bullet      moves everything
///   post-tick   contact impulses become the device's force until the next host step; the bodies'
///               states go to the island, where the tick reads them
// clang-format on
class NativeStep final : public HostStep {
 public:
  explicit NativeStep(SiteParts& parts);

  void addObject(SharedObject& object) override;
  void addProxy(Peer& peer, const Vec3& start_W) override;
  void addCoupler(SharedObject& object, CouplerIndex index,
                  const CouplerSettings& coupler) override;
  void finishSetUp() override {}
  [[nodiscard]] bool areBodiesPresent() noexcept override;
  [[nodiscard]] const Vec3& computeContactForce() noexcept override;
  void makeUp(double, double) noexcept override {}
  void advance(double now, double end) noexcept override;
  [[nodiscard]] bool isPlaceFree(const Peer& peer, double unknown) const noexcept override;
  void showProxy(Peer& peer) noexcept override;
  void before(double dt) noexcept override;
  void after(double dt) noexcept override;
  void leaveWorld() override { model_.reset(); }

 private:
  void holdGhosts() noexcept;

  SiteParts& site_;
  std::unique_ptr<NativeModel> model_;  ///< null once the host's world has ended
};

}  // namespace tandem
