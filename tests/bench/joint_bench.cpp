// Cost of a site's haptic tick while the hand presses what hangs on joints. The host's steps, at 60
// Hz, are not timed.
//
//   tandem_benchmarks --benchmark_filter=JointTick --benchmark_repetitions=9

#include <chrono>
#include <cmath>

#include <benchmark/benchmark.h>

#include "physics/arm_host.h"
#include "physics/joint_host.h"

namespace tandem {
namespace {

constexpr double kTick = 1e-3, kHostStep = 1.0 / 60.0;  // [s]

SiteSettings makeSettings() {
  SiteSettings settings;
  settings.peers = 1;
  settings.tick_source = TickSource::kCaller;
  settings.host_step = kHostStep;
  return settings;
}

/// Times ticks while the hand sways by a millimetre along `n_W`. `step` steps the host by
/// kHostStep.
template <typename Step>
void run(benchmark::State& state, Site& site, test::FakeDevice& device, const Vec3& n_W,
         const Step& step) {
  constexpr double kSway = 1e-3, kRate = 20.0;  // [m], [rad/s]
  const Vec3 middle_W = device.sample.hip.p_W;
  int ticks = 0, steps = 0;
  double pressed = 0.0;
  const auto goOn = [&] {
    using Clock = std::chrono::steady_clock;
    const double phase = kRate * kTick * ticks;
    device.sample.hip = {middle_W + kSway * std::sin(phase) * n_W,
                         kSway * kRate * std::cos(phase) * n_W};
    const auto start = Clock::now();
    site.tick(kTick * ticks);
    const std::chrono::duration<double> taken = Clock::now() - start;
    ++ticks;
    pressed += device.force_W.norm() > 0.05 ? 1.0 : 0.0;
    for (; kHostStep * (steps + 1) <= kTick * ticks; ++steps) step();
    return taken.count();
  };
  for (int i = 0; i < 1000; ++i) static_cast<void>(goOn());
  const int before = ticks;
  pressed = 0.0;
  for (auto _ : state) state.SetIterationTime(goOn());
  state.counters["pressed"] = pressed / (ticks - before);
}

/// Boxes that hang on hinges about y, one below the other; the hand presses the shared last one.
void runChain(benchmark::State& state, int count) {
  test::JointHost host;
  const Vec3 half(0.5 * test::JointHost::kLength, 0.0, 0.0);
  const Quat down = test::turn(0.5 * M_PI, Vec3::UnitY());
  for (int i = 0; i < count; ++i) {
    const Vec3 top_W(0.0, 0.0, -test::JointHost::kLength * i);
    btRigidBody& link = host.addLink(top_W + down * half);
    link.setWorldTransform(toBullet(Vec3(top_W + down * half), down));
    const btVector3 axis(0, 1, 0), end = toBullet(half);
    if (i == 0)
      host.join<btHingeConstraint>(link, -end, axis);
    else
      host.join<btHingeConstraint>(*host.links[static_cast<std::size_t>(i) - 1], link, end, -end,
                                   axis, axis);
  }
  const double radius = SiteSettings().hip_radius;
  const double z = -test::JointHost::kLength * (count - 0.5);
  host.device.sample.hip.p_W = Vec3(-0.5 * test::JointHost::kWidth - radius + 0.002, 0.0, z);
  host.share(*host.links.back(), makeSettings());
  run(state, *host.site, host.device, Vec3::UnitX(),
      [&] { host.rig.world.stepSimulation(btScalar(kHostStep), 0); });
}

void JointTickDoor(benchmark::State& state) { runChain(state, 1); }
BENCHMARK(JointTickDoor)->UseManualTime()->Unit(benchmark::kMicrosecond);

void JointTickChainOf6(benchmark::State& state) { runChain(state, 6); }
BENCHMARK(JointTickChainOf6)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// A multi-body whose motors hold it stretched out; the hand presses its last link.
void JointTickRobotOf7(benchmark::State& state) {
  test::ArmHost host;
  host.build(test::makeChain(7));
  for (int i = 0; i < 7; ++i)
    host.addMotor(i, 0.0, 1000.0 * kHostStep).setPositionTarget(0, btScalar(0.1));
  const double radius = SiteSettings().hip_radius;
  host.device.sample.hip.p_W = Vec3(6.5 * test::kLink, 0.0, 0.02 + radius - 0.002);
  host.start(makeSettings());
  run(state, *host.site, host.device, Vec3::UnitZ(), [&] { host.step(kHostStep); });
}
BENCHMARK(JointTickRobotOf7)->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tandem
