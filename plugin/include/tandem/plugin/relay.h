#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tandem/plugin/address.h"
#include "tandem/plugin/secret_key.h"
#include "tandem/plugin/udp_mesh.h"

#pragma GCC visibility push(default)
namespace tandem {

struct RelaySettings {
  Address bind;                 ///< port 0: any free port
  int rooms = 200;              ///< in use at the same time, 1 to 10,000
  int members = 32;             ///< of a room, 2 to 64; rooms * members is at most 65,535
  double datagram_rate = 10e3;  ///< of a member [1/s], above 0; more are dropped
  double byte_rate = 4e6;       ///< of a member [bytes/s], above 0; more are dropped
};

/// A room in which somebody is.
struct RelayRoom {
  std::string name;
  int members = 0;
  int watchers = 0;                   ///< of these
  std::uint64_t forwarded = 0;        ///< datagrams, since the room was opened
  std::uint64_t forwarded_bytes = 0;  ///< of them, with headers
  std::uint64_t too_many = 0;         ///< dropped, beyond a member's rate
};

struct RelayStatus {
  std::uint64_t received = 0;
  std::uint64_t forwarded = 0;
  std::uint64_t forwarded_bytes = 0;
  std::uint64_t unsent = 0;               ///< not taken by the system
  std::vector<RefusedDatagrams> refused;  ///< reasons that occurred so far (docs/relay.md)
  std::vector<RelayRoom> rooms;
  int members = 0;  ///< of all rooms
};

/// A process that forwards sealed datagrams among the members of rooms, over one UDP socket. It
/// cannot read or make what they say to each other. Members are UdpMeshes with the same key of the
/// relay. Takes all memory at the start. One thread.
class RelayServer {
 public:
  /// Throws std::invalid_argument for settings out of range or an address that cannot be bound, in
  /// one line. Throws tandem::Error if the system gives no socket.
  RelayServer(const RelaySettings& settings, SecretKey key);
  ~RelayServer();
  RelayServer(const RelayServer&) = delete;
  RelayServer& operator=(const RelayServer&) = delete;

  /// Takes the received datagrams and sends what is due. `now` [s] is any clock that does not run
  /// back. Never blocks and never allocates.
  void poll(double now) noexcept;
  /// Waits for a datagram, at most `seconds`.
  void wait(double seconds) const noexcept;
  /// File descriptor of the socket, for ppoll().
  [[nodiscard]] int handle() const noexcept;

  [[nodiscard]] RelayStatus status() const;
  [[nodiscard]] Address bound() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
