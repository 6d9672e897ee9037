#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "physics/neighbour_scene.h"

namespace tandem::test {

/// Sites that come and go while the others run. Each has a copy of one cube.
struct MemberHosts {
  static constexpr double kMass = 2.0 * NeighbourScene::kCubeMass;  // of the whole cube [kg]
  static constexpr double kRate = 60.0;                             // host steps [Hz]

  explicit MemberHosts(int sites) : scenes(sites), links(sites), begun(sites, 0.0) {
    settings.membership = {true, 1.0};
    settings.coordination_mode = CoordinationMode::kAverage;
    settings.contact = {2000.0, 10.0};
    settings.coordination = {50.0, 3.0};
    for (auto& row : links) row.resize(sites);
  }

  /// A program begins, with its cube at `p_W` and `v_W`. Its hand is far from all.
  NeighbourScene& come(int site, const Vec3& p_W = Vec3::Zero(), const Vec3& v_W = Vec3::Zero()) {
    for (int other = 0; other < count(); ++other) {
      links[site][other] = std::make_unique<FakeLink>(4096);
      if (links[other][site]) links[other][site]->has_left = false;
    }
    begun[site] = now;
    scenes[site] = std::make_unique<NeighbourScene>(has_weight);
    NeighbourScene& scene = *scenes[site];
    scene.settings = settings;
    scene.settings.self = idOf(site);
    scene.device.sample.hip.p_W = handOf(site);
    if (has_weight) scene.addFloor();
    scene.addCube(p_W);
    scene.cube->setLinearVelocity(toBullet(v_W));
    scene.start();
    for (int other = 0; other < count(); ++other)
      if (other != site) scene.site->connect(idOf(other), *links[site][other], handOf(other));
    return scene;
  }
  void vanish(int site) { scenes[site].reset(); }
  /// Says farewell to all.
  void leave(int site) {
    vanish(site);
    for (auto& row : links)
      if (row[site]) row[site]->has_left = true;
  }

  void run(double duration) {
    run(duration, [] {});
  }
  template <typename Each>
  void run(double duration, Each each) {
    for (int step = 0; step < std::lround(duration * kRate); ++step) {
      for (int i = 0; i < count(); ++i) {
        if (!scenes[i]) continue;
        scenes[i]->rig.step(1.0 / kRate);
        carryFrom(i);
      }
      now += 1.0 / kRate;
      each();
    }
  }

  [[nodiscard]] int count() const { return static_cast<int>(scenes.size()); }
  [[nodiscard]] int countPresent() const {
    int present = 0;
    for (const auto& scene : scenes) present += scene != nullptr;
    return present;
  }
  [[nodiscard]] Vec3 positionAt(int site) const {
    return NeighbourScene::positionOf(*scenes[site]->cube);
  }
  [[nodiscard]] Vec3 velocityAt(int site) const {
    return NeighbourScene::velocityOf(*scenes[site]->cube);
  }
  [[nodiscard]] double massAt(int site) const {
    return 1.0 / static_cast<double>(scenes[site]->cube->getInvMass());
  }
  [[nodiscard]] double computeSpread() const {
    double spread = 0.0;
    for (int i = 0; i < count(); ++i)
      for (int k = 0; k < i; ++k)
        if (scenes[i] && scenes[k])
          spread = std::max(spread, (positionAt(i) - positionAt(k)).norm());
    return spread;
  }

  SiteSettings settings;
  bool has_weight = false;
  double delay = 0.02, now = 0.0;  // [s]
  std::vector<std::unique_ptr<NeighbourScene>> scenes;
  std::vector<std::vector<std::unique_ptr<FakeLink>>> links;  // of a site to another
  std::vector<double> begun;                                  // by site [s]

 private:
  static PeerId idOf(int site) { return PeerId{static_cast<std::uint32_t>(site) + 1}; }
  static Vec3 handOf(int site) { return {0.0, 2.0 * site, 10.0}; }

  void carryFrom(int from) {
    for (int to = 0; to < count(); ++to) {
      FakeLink& out = *links[from][to];
      if (scenes[to])
        for (const StatePacket& packet : out.sent)
          links[to][from]->arrivals.push_back(
              {packet, packet.time + begun[from] + delay - begun[to]});
      out.sent.clear();
    }
  }
};

}  // namespace tandem::test
