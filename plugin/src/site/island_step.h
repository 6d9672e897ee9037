#pragma once

#include "site/host_step.h"
#include "site/site_parts.h"

namespace tandem {

/// Shared part of the strategies with an island: the island computes contact, and proxies are
/// spheres in the host's world.
class IslandStep : public HostStep {
 public:
  explicit IslandStep(SiteParts& parts);

  void addObject(SharedObject& object) override;
  void addProxy(Peer& peer, const Vec3& start_W) override;
  void finishSetUp() override;
  [[nodiscard]] bool areBodiesPresent() noexcept override;
  void addCoupler(SharedObject&, CouplerIndex, const CouplerSettings&) override {}
  [[nodiscard]] const Vec3& computeContactForce() noexcept override {
    return site_.hand.computeContactForce();
  }
  [[nodiscard]] bool isPlaceFree(const Peer& peer, double unknown) const noexcept override;
  void leaveNeighbours() override;

 protected:
  /// True while nothing is registered and no tick has run: host steps need no work.
  [[nodiscard]] bool isWaiting() const noexcept;
  /// Ends a host step of a waiting site. Obstacles may move before the first tick, so they are
  /// searched now and then.
  void wait(double dt);
  /// Searches the surroundings at once, outside of a host step.
  void lookAround(double dt);
  /// Makes room for the snapshots that a late host may ask for.
  void makeRoomFor(double dt);

  SiteParts& site_;

 private:
  int waited_ = 0;  ///< host steps
};

}  // namespace tandem
