// Cost of one moment of packets: 256 objects and 15 peers, of which some are near.
//
//   tandem_benchmarks --benchmark_filter=Interest --benchmark_repetitions=9

#include <limits>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "site/parts_rig.h"

namespace tandem {
namespace {

constexpr int kObjects = 256, kPeers = 15, kMoving = 8;

/// `state.range(0)`: peers near the local hand. `state.range(1)`: the budget [kbit/s], 0 for none.
void InterestPacketMoment(benchmark::State& state) {
  SiteSettings settings;
  settings.thins_when_idle = false;
  if (state.range(1) > 0) settings.packet_budget = 1e3 * static_cast<double>(state.range(1));
  test::PartsRig rig(kObjects, settings);
  std::vector<std::unique_ptr<test::FakeLink>> links;
  for (int i = 0; i < kPeers; ++i) {
    const PeerId id{static_cast<std::uint32_t>(i) + 2};
    links.push_back(std::make_unique<test::FakeLink>());
    rig.connect(*links.back(), id);
    const Vec3 hand_W(0, i < state.range(0) ? 0.1 : 50.0, 0);
    links.back()->arrivals.push_back({test::makePacket(id, 1, hand_W), 0.0});
  }
  rig.timeline.begin(0.0, 0.0);
  rig.peers.takeInUntil(0.0, 0.0);
  double z = 0.0;
  for (auto _ : state) {
    z += 1e-5;
    for (int i = 0; i < kMoving; ++i) {
      RigidState moved = rig.island.state(rig.index(30 * i));
      moved.p_W.z() = z;
      rig.island.setState(rig.index(30 * i), moved);
    }
    rig.sender.sendIfDue(rig.sender.due(), true);
  }
}
BENCHMARK(InterestPacketMoment)->Args({0, 1000})->Args({1, 1000})->Args({15, 1000})->Args({0, 0});

}  // namespace
}  // namespace tandem
