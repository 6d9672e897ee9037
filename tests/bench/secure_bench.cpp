// Cost of sealing, opening and refusing datagrams, and of a handshake.
//
//   tandem_benchmarks --benchmark_filter=Secure --benchmark_repetitions=9

#include <array>
#include <vector>

#include <benchmark/benchmark.h>

#include "secure/cookie.h"
#include "secure/handshake.h"
#include "secure/seal.h"

namespace tandem::secure {
namespace {

constexpr std::array<std::uint8_t, 32> kHeader{};

SecretKey makeKey() {
  std::array<std::uint8_t, SecretKey::kSize> bytes{};
  return SecretKey::take(bytes);
}

/// A datagram with a text of this size, sealed as number 0.
std::vector<std::uint8_t> makeDatagram(benchmark::State& state) {
  std::vector<std::uint8_t> datagram(static_cast<std::size_t>(state.range(0)) + kTagSize);
  if (!Sealer(makeKey(), 1).seal(kHeader, datagram)) state.SkipWithError("not sealed");
  return datagram;
}

void SecureSeal(benchmark::State& state) {
  Sealer sealer(makeKey(), 1);
  auto datagram = makeDatagram(state);
  for (auto _ : state) benchmark::DoNotOptimize(sealer.seal(kHeader, datagram));
}
BENCHMARK(SecureSeal)->Arg(160)->Arg(1184);

void SecureOpen(benchmark::State& state) {
  const Opener opener(makeKey(), 1);
  const auto sealed = makeDatagram(state);
  for (auto _ : state) {
    auto datagram = std::array<std::uint8_t, 1200>();
    std::copy(sealed.begin(), sealed.end(), datagram.begin());
    if (!opener.open(0, kHeader, Bytes(datagram).first(sealed.size())))
      state.SkipWithError("not opened");
  }
}
BENCHMARK(SecureOpen)->Arg(160)->Arg(1184);

void SecureRefuse(benchmark::State& state) {
  const Opener opener(makeKey(), 1);
  auto datagram = makeDatagram(state);
  for (auto _ : state) {
    if (opener.open(1, kHeader, datagram)) state.SkipWithError("opened");
  }
}
BENCHMARK(SecureRefuse)->Arg(160)->Arg(1184);

void SecureCookieAccept(benchmark::State& state) {
  const CookieMaker maker;
  const CookieSubject subject{1, 2, 3};
  const Cookie cookie = maker.make(subject, 5.0);
  for (auto _ : state) benchmark::DoNotOptimize(maker.accepts(cookie, subject, 5.0));
}
BENCHMARK(SecureCookieAccept);

/// Both sides of a handshake, from ephemeral keys to the split.
void SecureHandshake(benchmark::State& state) {
  const SecretKey shared = makeKey();
  std::array<std::uint8_t, 100> first, second, payload;
  const auto message1 = Bytes(first).first(kHandshakeOverhead + 8);
  const auto message2 = Bytes(second).first(kHandshakeOverhead + 8);
  for (auto _ : state) {
    Initiator initiator(shared, kHeader);
    Responder responder(shared, kHeader);
    if (!initiator.writeMessage(ByteView(kHeader).first(8), message1) ||
        !responder.readMessage(message1, payload) ||
        !responder.writeMessage(ByteView(kHeader).first(8), message2) ||
        !initiator.readMessage(message2, payload))
      state.SkipWithError("refused");
    benchmark::DoNotOptimize(initiator.split());
    benchmark::DoNotOptimize(responder.split());
  }
}
BENCHMARK(SecureHandshake)->Unit(benchmark::kMicrosecond);

/// Cost of a forged message 1 for a waiting responder.
void SecureRefuseHandshake(benchmark::State& state) {
  Responder responder(makeKey(), kHeader);
  const std::array<std::uint8_t, kHandshakeOverhead + 8> forged{};
  std::array<std::uint8_t, 8> payload;
  for (auto _ : state) {
    if (responder.readMessage(forged, payload)) state.SkipWithError("accepted");
  }
}
BENCHMARK(SecureRefuseHandshake)->Unit(benchmark::kMicrosecond);

void SecureKeyMemory(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(SecretKey::generate());
}
BENCHMARK(SecureKeyMemory)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace tandem::secure
