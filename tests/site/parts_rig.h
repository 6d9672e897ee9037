#pragma once

#include <memory>
#include <vector>

#include "plugin/src/site/host_forces.h"
#include "plugin/src/site/host_step.h"
#include "plugin/src/site/packet_sender.h"
#include "support/fakes.h"

namespace tandem::test {

constexpr double kPeriod = 1e-3;  // of the ticks [s]

/// The parts of a site without a Bullet world: free spheres in an island, 1 m apart.
struct PartsRig {
  explicit PartsRig(int objects = 0, const SiteSettings& wanted = {}) : settings(wanted) {
    for (int i = 0; i < objects; ++i) {
      SharedObject object;
      IslandBody body;
      body.mass = kMass;
      body.inertia_B = Vec3::Constant(kInertia);
      body.start.p_W = Vec3(i + 1.0, 0, 0);
      object.id = static_cast<ObjectId>(i);
      object.body.index = island.addBody(body);
      object.body.is_held = true;
      object.body.load.makeRoom();
      bodies.objects.push_back(std::move(object));
    }
    finishSetUp();
  }

  void finishSetUp() {
    island.prepare();
    bodies.clearList();
    for (SharedObject& object : bodies.objects) bodies.list(object.body);
    timeline.setBodyCount(static_cast<std::size_t>(island.bodyCount()));
    sender.setSize(bodies.objects.size(), static_cast<std::size_t>(peers.count()));
    log.makeRoom(bodies.objects.size(), static_cast<std::size_t>(peers.count()));
  }

  /// Connects a peer and couples each object to its copy there. Sites do this in Peers::tie(),
  /// which needs bodies of Bullet.
  Peer& connect(Link& link, PeerId id = PeerId{2}) {
    peers.add(peers.make(id, link, Vec3(0, 1, 0)));
    Peer& peer = peers[peers.count() - 1];
    for (const SharedObject& object : bodies.objects) {
      Tie& tie = peer.ties.emplace_back();
      tie.coupler = island.addCoupler(object.body.index, {settings.coordination, {}});
      tie.theirs = island.state(object.body.index);
    }
    finishSetUp();
    return peer;
  }

  [[nodiscard]] BodyIndex index(int object) const {
    return bodies.objects[static_cast<std::size_t>(object)].body.index;
  }
  [[nodiscard]] SiteBody& body(int object) {
    return bodies.objects[static_cast<std::size_t>(object)].body;
  }
  void setVelocity(int object, const Vec3& v_W) {
    RigidState state = island.state(index(object));
    state.v_W = v_W;
    island.setState(index(object), state);
  }

  static constexpr double kMass = 0.5;      // [kg]
  static constexpr double kInertia = 2e-4;  // about every axis [kg m^2]

  SiteSettings settings;
  test::FakeDevice device;
  SiteLog log;
  Island island{IslandSettings{}};
  Timeline timeline{island, kPeriod, 0.0};
  HostClock clock{0.0, 0.0};
  Bodies bodies;
  LocalHand hand{device, settings, island, true};
  HostForces forces{island, timeline, clock, bodies, hand.energy()};
  Peers peers{settings, island, bodies, hand.energy(), log};
  Grips grips{settings, island, bodies, hand, peers, log, true};
  PacketSender sender{settings, island, timeline, bodies, hand, peers, grips, log};
};

/// A strategy that moves nothing. Every place is free.
class NoHostStep final : public HostStep {
 public:
  void addObject(SharedObject&) override {}
  void addProxy(Peer&, const Vec3&) override {}
  void addCoupler(SharedObject&, CouplerIndex, const CouplerSettings&) override {}
  void finishSetUp() override {}
  [[nodiscard]] bool areBodiesPresent() noexcept override { return true; }
  [[nodiscard]] const Vec3& computeContactForce() noexcept override { return contact_W_; }
  void makeUp(double, double) noexcept override {}
  void advance(double, double) noexcept override {}
  [[nodiscard]] bool isPlaceFree(const Peer&, double) const noexcept override { return true; }
  void showProxy(Peer&) noexcept override {}
  void before(double) noexcept override {}
  void after(double) noexcept override {}

 private:
  Vec3 contact_W_ = Vec3::Zero();
};

}  // namespace tandem::test
