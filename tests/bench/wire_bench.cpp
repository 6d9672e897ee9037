// Cost of writing and of reading one STATE, with all checks and rounding but without sealing.
//
//   tandem_benchmarks --benchmark_filter=Wire --benchmark_repetitions=9

#include <array>
#include <cstddef>
#include <cstdint>

#include <benchmark/benchmark.h>

#include "coordination/src/wire/replay_window.h"
#include "coordination/src/wire/wire_state.h"

namespace tandem {
namespace {

/// A state with as many objects as the benchmark's first argument says.
StateMessage makeMessage(const benchmark::State& state, WireProfile profile) {
  StateMessage message;
  message.packet.sender = PeerId{1};
  message.packet.time = 12.5;
  message.packet.user = {Vec3(0.1, 0.2, 0.3), Vec3(0.4, 0.5, 0.6)};
  message.profile = profile;
  message.packet.object_count = static_cast<std::uint32_t>(state.range(0));
  for (ObjectId i = 0; i < message.packet.object_count; ++i) {
    message.packet.objects[i] = {i,
                                 {Vec3(0.1, 0.2, 0.3), Quat(1.0, 0.2, -0.3, 0.4).normalized(),
                                  Vec3(0.1, 0.0, -0.1), Vec3(1.0, -2.0, 3.0)}};
  }
  return message;
}

void reportSize(benchmark::State& state, std::size_t payload) {
  state.counters["datagram_bytes"] = static_cast<double>(kHeaderSize + payload + kTagSize);
}

template <WireProfile kProfile>
void WireEncodeState(benchmark::State& state) {
  StateMessage message = makeMessage(state, kProfile);
  std::array<std::uint8_t, kMaxPayloadSize> room{};
  std::size_t size = 0;
  for (auto _ : state) {
    ++message.packet.sequence;
    size = encodeState(message, {room.data(), room.size()});
    benchmark::DoNotOptimize(room.data());
    benchmark::ClobberMemory();
  }
  reportSize(state, size);
}
BENCHMARK_TEMPLATE(WireEncodeState, WireProfile::kFloat32)->Arg(1)->Arg(8);
BENCHMARK_TEMPLATE(WireEncodeState, WireProfile::kFloat64)->Arg(1)->Arg(8);

template <WireProfile kProfile>
void WireDecodeState(benchmark::State& state) {
  std::array<std::uint8_t, kMaxPayloadSize> room{};
  const std::size_t size = encodeState(makeMessage(state, kProfile), {room.data(), room.size()});
  for (auto _ : state) {
    benchmark::DoNotOptimize(room.data());
    benchmark::ClobberMemory();
    const auto message = decodeState({room.data(), size}, PeerId{1});
    benchmark::DoNotOptimize(message->packet.user.p_W.x());
  }
  reportSize(state, size);
}
BENCHMARK_TEMPLATE(WireDecodeState, WireProfile::kFloat32)->Arg(1)->Arg(8);
BENCHMARK_TEMPLATE(WireDecodeState, WireProfile::kFloat64)->Arg(1)->Arg(8);

void WireReplayWindow(benchmark::State& state) {
  ReplayWindow window;
  std::uint64_t sequence = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(window.check(sequence) && window.commit(sequence++));
}
BENCHMARK(WireReplayWindow);

}  // namespace
}  // namespace tandem
