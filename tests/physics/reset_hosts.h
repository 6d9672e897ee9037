#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "physics/neighbour_scene.h"
#include "support/random.h"

namespace tandem::test {

/// Sites with a copy of one cube each, on a wide floor, all linked to each other.
struct ResetHosts {
  struct Wanted {
    int sites = 2;
    double rate = 60.0;  // host steps [Hz]
    double delay = 0.02;
    bool puts = true;     // SiteSettings::puts_reset_objects
    double loss = 0.0;    // of packets; as many are doubled
    double jitter = 0.0;  // [s]; packets overtake
    double settle = 0.5;  // run after the start [s]
    Vec3 start = Vec3(0.0, 0.0, NeighbourScene::kHalf);
    bool has_one_clock = false;  // packets tell the time of the whole run, not of their program
  };

  explicit ResetHosts(const Wanted& as) : wanted(as) {
    for (int i = 0; i < as.sites; ++i) {
      scenes.emplace_back();
      begun.push_back(0.0);
      links.emplace_back();
      for (int j = 0; j < as.sites; ++j) links.back().push_back(std::make_unique<FakeLink>(4096));
    }
    for (int i = 0; i < as.sites; ++i) begin(i);
    run(as.settle);
  }

  /// Runs all. Returns the greatest speed of a cube in Bullet.
  double run(double duration) {
    double fastest = 0.0;
    for (int step = 0; step < duration * wanted.rate - 1e-6; ++step) {
      for (int i = 0; i < wanted.sites; ++i) {
        if (!scenes[i]) continue;
        scenes[i]->rig.step(1.0 / wanted.rate);
        carryFrom(i);
        fastest = std::max(fastest, NeighbourScene::velocityOf(*scenes[i]->cube).norm());
      }
      now += 1.0 / wanted.rate;
    }
    return fastest;
  }

  /// Ends a site's program; after `outage` [s] another begins, with packets from 0.
  void restart(int site, double outage) {
    scenes[site].reset();
    run(outage);
    for (auto& link : links[site]) link = std::make_unique<FakeLink>(4096);
    begin(site);
  }

  void put(int site, const Vec3& p_W, const Quat& q_WB = Quat::Identity()) {
    btRigidBody& cube = *scenes[site]->cube;
    const btTransform pose = toBullet(p_W, q_WB);
    cube.setWorldTransform(pose);
    cube.setInterpolationWorldTransform(pose);
  }
  void put(int site, double x) { put(site, Vec3(x, 0.0, NeighbourScene::kHalf)); }
  /// Resets a site's world as hosts do it: pose, and no velocity.
  void reset(int site, const Vec3& p_W) {
    put(site, p_W);
    btRigidBody& cube = *scenes[site]->cube;
    cube.setLinearVelocity(btVector3(0, 0, 0));
    cube.setAngularVelocity(btVector3(0, 0, 0));
    cube.clearForces();
  }
  [[nodiscard]] Vec3 at(int site) const { return NeighbourScene::positionOf(*scenes[site]->cube); }
  [[nodiscard]] const SiteCounters& counters(int site) const {
    return scenes[site]->site->counters();
  }

  Wanted wanted;
  double now = 0.0;           // [s]
  std::vector<double> begun;  // by site: when its program began [s]
  std::vector<std::unique_ptr<NeighbourScene>> scenes;
  std::vector<std::vector<std::unique_ptr<FakeLink>>> links;
  Random random{16};

 private:
  static PeerId idOf(int site) { return PeerId{static_cast<std::uint32_t>(site) + 1}; }

  void begin(int site) {
    begun[site] = now;
    scenes[site] = std::make_unique<NeighbourScene>(true);
    NeighbourScene& scene = *scenes[site];
    scene.settings.self = idOf(site);
    scene.device.sample.hip.p_W = Vec3(0.0, 2.0 * site, 10.0);  // hands are apart
    scene.settings.peers = wanted.sites;
    scene.settings.coordination = {50.0, 3.0};  // stable at these delays
    scene.settings.puts_reset_objects = wanted.puts;
    scene.rig.addBody(scene.rig.makeShape<btBoxShape>(btVector3(20, 20, 1)), 0.0,
                      Vec3(0.0, 0.0, -1.0));
    scene.start(wanted.start);
    for (int j = 0; j < wanted.sites; ++j)
      if (j != site) scene.site->connect(idOf(j), *links[site][j], Vec3(0, 15, 5));
  }
  void carryFrom(int from) {
    for (int to = 0; to < wanted.sites; ++to) {
      FakeLink& out = *links[from][to];
      for (const StatePacket& packet : out.sent) {
        if (random.uniform(0.0, 1.0) < wanted.loss) continue;
        arrive(from, to, packet);
        if (random.uniform(0.0, 1.0) < wanted.loss) arrive(from, to, packet);
      }
      out.sent.clear();
    }
  }
  void arrive(int from, int to, StatePacket packet) {
    const double sent = packet.time + begun[from];
    if (wanted.has_one_clock) packet.time = sent;
    const double time = sent + wanted.delay + random.uniform(0.0, wanted.jitter) - begun[to];
    auto& arrivals = links[to][from]->arrivals;
    const auto behind = std::find_if(arrivals.begin(), arrivals.end(),
                                     [&](const Arrival& other) { return other.time > time; });
    arrivals.insert(behind, {packet, time});
  }
};

}  // namespace tandem::test
