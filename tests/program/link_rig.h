#pragma once

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/udp_socket.h"

#include "program/background.h"
#include "program/tandem_program.h"

/// \file
/// `tandem link` between two sockets of the test, on loopback.
namespace tandem::test {

using Bytes = std::vector<std::uint8_t>;

/// Datagram `number`. Any two of them differ in many bits.
[[nodiscard]] inline Bytes makeDatagram(std::uint64_t number) {
  Bytes bytes(64);
  std::uint64_t state = number;
  for (std::uint8_t& byte : bytes) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    byte = static_cast<std::uint8_t>(state >> 56U);
  }
  return bytes;
}

/// A socket that sends and receives whole datagrams.
class Endpoint {
 public:
  void send(const Bytes& bytes, const Address& to) {
    socket_.send({bytes.data(), bytes.size()}, to);
  }

  struct Arrived {
    Bytes bytes;
    double at = 0.0;  ///< [s], readMonotonicClock()
    Address from;
  };
  /// The next datagram; empty if none comes within `seconds`.
  [[nodiscard]] std::optional<Arrived> receive(double seconds) {
    Bytes room(2048);
    const double until = readMonotonicClock() + seconds;
    do {
      if (const auto got = socket_.receive({room.data(), room.size()})) {
        room.resize(got->size);
        return Arrived{room, readMonotonicClock(), got->from};
      }
      socket_.wait(until - readMonotonicClock());
    } while (readMonotonicClock() < until);
    return std::nullopt;
  }

  [[nodiscard]] Address address() const { return socket_.bound(); }

 private:
  net::UdpSocket socket_{resolveAddress("127.0.0.1:0")};
};

/// Longer than any of these tests needs [s]: a wait that reaches it has failed.
inline constexpr double kPatience = 60.0;

/// Client and server with the link between them.
struct LinkRig {
  explicit LinkRig(std::vector<std::string> arguments = {})
      : link(tandemProgram(), [&] {
          arguments.insert(arguments.begin(), {"link", "--listen", "127.0.0.1:0", "--forward",
                                               toString(server.address())});
          return arguments;
        }()) {
    const std::string line = link.readLine(), before = "listening on ";
    EXPECT_EQ(line.substr(0, before.size()), before);
    proxy = resolveAddress(line.substr(before.size()));
  }

  Endpoint server, client;
  Background link;
  Address proxy;  ///< address that the client sends to
};

}  // namespace tandem::test
