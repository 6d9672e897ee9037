#pragma once

#include <cstdint>
#include <optional>

#include "tandem/coordination/datagram.h"
#include "tandem/plugin/address.h"

#pragma GCC visibility push(default)
namespace tandem::net {

/// Takes datagrams that are to be sent: a socket, or a simulated network.
class Outlet {
 public:
  virtual ~Outlet() = default;
  /// Never blocks; what cannot be sent is lost, as on any network.
  virtual void send(ByteView datagram, const Address& to) noexcept = 0;
};

/// A non-blocking UDP socket for IPv6 and IPv4. Datagrams are never fragmented by us and the
/// buffers are small: what cannot be sent or taken in at once is too old to be of use.
class UdpSocket final : public Outlet {
 public:
  /// Binds. Throws std::invalid_argument if the address is in use or not of this machine (in one
  /// line, with the remedy), tandem::Error if the system gives no socket.
  explicit UdpSocket(const Address& bind);
  ~UdpSocket() override;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  void send(ByteView datagram, const Address& to) noexcept override;

  struct Received {
    std::size_t size = 0;  ///< may be 0: a datagram without bytes
    Address from;
  };
  /// The next datagram; nothing if none is there. A longer one than `room` is cut to room.size.
  [[nodiscard]] std::optional<Received> receive(ByteSpan room) noexcept;

  /// Waits until something is there or `seconds` have passed.
  void wait(double seconds) const noexcept;

  /// For poll(), where several sockets are waited for.
  [[nodiscard]] int handle() const noexcept { return socket_; }

  [[nodiscard]] Address bound() const noexcept;
  [[nodiscard]] std::uint64_t unsent() const noexcept { return unsent_; }

 private:
  int socket_ = -1;
  bool is_ipv4_ = false;  ///< a machine without IPv6
  std::uint64_t unsent_ = 0;
};

}  // namespace tandem::net
#pragma GCC visibility pop
