#pragma once

#include "site/host_step.h"
#include "site/site_parts.h"

namespace tandem {

/// What the ways with an island have in common: contact is the island's, and proxies stand in the
/// host's world as spheres.
class IslandStep : public HostStep {
 public:
  explicit IslandStep(SiteParts& parts) : site_(parts) {}

  void addObject(SharedObject& object) override;
  void addProxy(Peer& peer, const Vec3& start_W) override;
  [[nodiscard]] bool areBodiesPresent() noexcept override { return site_.areBodiesPresent(); }
  void addCoupler(SharedObject&, CouplerIndex, const CouplerSettings&) override {}
  [[nodiscard]] Vec3 computeContactForce() noexcept override {
    return site_.hand.computeContactForce();
  }
  [[nodiscard]] bool isPlaceFree(const Peer& peer, double unknown) const noexcept override;
  void leaveNeighbours() override;

 protected:
  /// With nothing registered and nobody who ticks yet a host's step is not looked at.
  [[nodiscard]] bool isWaiting() const noexcept;
  /// The end of such a step. What stands may be moved before the first tick: it is looked at now
  /// and then.
  void wait(double dt);
  /// Looks around at once, outside of a host's step.
  void lookAround(double dt);
  /// Room for the moments that a host as late as it may be asks for.
  void makeRoomFor(double dt);

  SiteParts& site_;

 private:
  int waited_ = 0;  ///< host steps
};

}  // namespace tandem
