// tandem_flood PORT RATE SECONDS: sends RATE forged datagrams a second to 127.0.0.1:PORT and prints
// how many it sent. For scripts/soak.sh.
//
// Kinds take turns: a STATE as if replayed, of an unknown session; HELLO and OPEN with a
// wrong tag; invalid bytes.

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>

#include "tandem/plugin/udp_socket.h"

#include "coordination/src/wire/wire_handshake.h"

namespace tandem {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(1);  ///< period of bursts

class Forger {
 public:
  Forger() {
    for (std::uint8_t& byte : bytes_) byte = static_cast<std::uint8_t>(random_());
  }
  ByteView make() {
    const ByteSpan out{bytes_.data(), bytes_.size()};
    const HandshakeRoute route{PeerId{1}, PeerId{2}, random_() | 1U};
    switch (made_++ % 4) {
      case 0: {
        ClearHeader header;
        header.session = static_cast<std::uint32_t>(random_()) | 1U;
        header.sender = PeerId{1};
        header.key_epoch = static_cast<std::uint16_t>(random_()) | 1U;
        header.sequence = random_() % 10000;
        (void)encodeHeader(header, out);
        return {bytes_.data(), 172};
      }
      case 1:
        return {bytes_.data(), encodeHello({route, {}}, out)};
      case 2: {
        OpenMessage open;
        open.route = route;
        open.key_epoch = 1;
        return {bytes_.data(), encodeOpen(open, out)};
      }
      default:
        bytes_[0] = bytes_[random_() % bytes_.size()];
        return {bytes_.data(), 20 + random_() % 1000};
    }
  }

 private:
  std::mt19937_64 random_{20090408};
  std::uint64_t made_ = 0;
  std::array<std::uint8_t, kMaxDatagramSize> bytes_{};
};

int flood(std::uint16_t port, double rate, double seconds) {
  Address to = resolveAddress("127.0.0.1:1");
  to.port = port;
  net::UdpSocket socket(resolveAddress("127.0.0.1:0"));
  Forger forger;
  std::uint64_t sent = 0;
  const auto start = std::chrono::steady_clock::now();
  auto next = start;
  for (double passed = 0.0; passed < seconds;) {
    passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto due = static_cast<std::uint64_t>(rate * passed);
    // A busy machine catches up in small parts.
    for (int i = 0; i < 1000 && sent < due; ++i, ++sent) socket.send(forger.make(), to);
    next = std::max(next + kPeriod, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
  std::printf("%llu sent, %llu of them refused by the system\n",
              static_cast<unsigned long long>(sent),
              static_cast<unsigned long long>(socket.unsent()));
  return 0;
}

}  // namespace
}  // namespace tandem

int main(int count, char** arguments) {
  if (count != 4) {
    std::fputs("usage: tandem_flood PORT RATE SECONDS\n", stderr);
    return 2;
  }
  return tandem::flood(static_cast<std::uint16_t>(std::atoi(arguments[1])), std::atof(arguments[2]),
                       std::atof(arguments[3]));
}
