// Extra cost of a host's step with a site attached and nothing registered. One world runs bare and
// attached in turns, so both use the same memory. Prints medians over the turns.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

namespace tandem {
namespace {

constexpr int kSteps = 2000;  // steps of a block
constexpr double kStep = 1.0 / 240.0;

/// A world with `count` free cubes that never sleep.
struct Host {
  explicit Host(int cubes) {
    world.setGravity(btVector3(0, 0, 0));
    for (int i = 0; i < cubes; ++i) {
      btTransform pose = btTransform::getIdentity();
      pose.setOrigin(btVector3(btScalar(0.1 * i), 0, 0));
      bodies.push_back(
          std::make_unique<btRigidBody>(btScalar(0.2), nullptr, &shape,
                                        btVector3(btScalar(5e-5), btScalar(5e-5), btScalar(5e-5))));
      bodies.back()->setWorldTransform(pose);
      bodies.back()->setActivationState(DISABLE_DEACTIVATION);
      world.addRigidBody(bodies.back().get());
    }
  }
  ~Host() {
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }
  /// Time of a step, over a block [us].
  double measure() {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kSteps; ++i) world.stepSimulation(static_cast<btScalar>(kStep), 0);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    return took.count() / kSteps;
  }

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btBoxShape shape{btVector3(btScalar(0.02), btScalar(0.02), btScalar(0.02))};
  std::vector<std::unique_ptr<btRigidBody>> bodies;
};

/// The source of ticks, and the number of ticks before the block.
struct Way {
  const char* name;
  TickSource source;
  int ticks;  // before the block
};
constexpr Way kWays[] = {{"its caller ticks, not yet", TickSource::kCaller, 0},
                         {"its caller ticks, the hand rests", TickSource::kCaller, 50},
                         {"the step ticks, the hand rests", TickSource::kHostStep, 0}};

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void measure(int cubes, int turns) {
  Host host(cubes);
  SimulatedDeviceSettings far;
  far.start_W = Vec3(-1.0, 0.0, 0.0);
  for (const Way& way : kWays) {
    std::vector<double> bare, more;
    for (int turn = 0; turn < turns; ++turn) {
      const double before = host.measure();
      SimulatedDevice device(far, makeConstantHand({0, 0, 0}));
      SiteSettings settings;
      settings.tick_source = way.source;
      double with = 0.0;
      {
        Site site(settings, host.world, device);
        for (int tick = 0; tick < way.ticks; ++tick) (void)site.tick(1e-3 * tick);
        with = host.measure();
      }
      const double after = host.measure();
      bare.push_back(0.5 * (before + after));
      more.push_back(with - bare.back());
    }
    std::printf("%4d cubes, %-34s bare %8.3f us, attached %+.4f us\n", cubes, way.name,
                medianOf(bare), medianOf(more));
  }
}

}  // namespace
}  // namespace tandem

int main(int argc, char** argv) {
  const int turns = argc > 1 ? std::atoi(argv[1]) : 201;
  for (const int cubes : {0, 1, 100}) tandem::measure(cubes, cubes > 10 ? turns / 4 : turns);
}
