// Cost of Island::advance for one haptic period, by kind of scene.
//
//   tandem_benchmarks --benchmark_filter=Island --benchmark_repetitions=9

#include <benchmark/benchmark.h>

#include "bench/scenes/island_chain.h"

namespace tandem {
namespace {

using demos::bench::IslandChain;

void run(benchmark::State& state, IslandChain chain) {
  for (int i = 0; i < 2000; ++i) chain.tick();  // caches warm, start-up motion over
  for (auto _ : state) chain.tick();
  benchmark::DoNotOptimize(chain.cube());
}

void IslandLoneCouplers(benchmark::State& state) { run(state, demos::bench::makeLoneCouplers()); }
BENCHMARK(IslandLoneCouplers);

void IslandLoneCouplersCubeMayTurn(benchmark::State& state) {
  run(state, IslandChain({2000.0, 10.0}, 0.05, true));
}
BENCHMARK(IslandLoneCouplersCubeMayTurn);

/// Stiffness and damping of the contacts [N/m, N s/m].
void IslandThreeInContact(benchmark::State& state) {
  const CouplerGains contact{static_cast<double>(state.range(0)),
                             static_cast<double>(state.range(1))};
  run(state, IslandChain(contact, -1e-3, true));
}
BENCHMARK(IslandThreeInContact)->Args({2000, 10})->Args({4000, 1})->Args({4000, 10});

}  // namespace
}  // namespace tandem

BENCHMARK_MAIN();
