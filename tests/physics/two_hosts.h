#pragma once

#include <algorithm>

#include "physics/neighbour_scene.h"

namespace tandem::test {

/// Two sites with a copy of one cube each, 20 ms apart unless said.
struct TwoHosts {
  NeighbourScene here{true}, there{true};
  double delay = 0.02;

  TwoHosts() {
    for (int i = 0; i < 2; ++i) {
      NeighbourScene& scene = *scenes_[i];
      scene.settings.self = PeerId{static_cast<std::uint32_t>(i) + 1};
      scene.settings.coordination = {50.0, 3.0};  // stable at this delay
      scene.rig.addBody(scene.rig.makeShape<btBoxShape>(btVector3(20, 20, 1)), 0.0,
                        Vec3(0.0, 0.0, -1.0));
      scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
      scene.site->connect(PeerId{static_cast<std::uint32_t>(2 - i)}, links_[i], Vec3(0, 15, 5));
    }
    run(0.5);
  }

  /// Runs both; `push` [N] acts on the other host's cube. Returns the greatest speed of a cube.
  double run(double duration, double push = 0.0) {
    double fastest = 0.0;
    for (int step = 0; step < duration * 60.0; ++step) {
      if (push != 0.0) there.cube->activate(true);
      there.cube->applyCentralForce(btVector3(static_cast<btScalar>(push), 0, 0));
      for (int i = 0; i < 2; ++i) {
        scenes_[i]->rig.step(1.0 / 60.0);
        for (const StatePacket& packet : links_[i].sent)
          links_[1 - i].arrivals.push_back({packet, packet.time + delay});
        links_[i].sent.clear();
        fastest = std::max(fastest, NeighbourScene::velocityOf(*scenes_[i]->cube).norm());
      }
    }
    return fastest;
  }

  static double x(const NeighbourScene& scene) {
    return NeighbourScene::positionOf(*scene.cube).x();
  }
  static void put(NeighbourScene& scene, double x) {
    const btTransform pose = toBullet(Vec3(x, 0.0, NeighbourScene::kHalf), Quat::Identity());
    scene.cube->setWorldTransform(pose);
    scene.cube->setInterpolationWorldTransform(pose);
  }

 private:
  NeighbourScene* scenes_[2] = {&here, &there};
  FakeLink links_[2] = {FakeLink(4096), FakeLink(4096)};
};

}  // namespace tandem::test
