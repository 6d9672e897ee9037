#pragma once

#include <cstdint>
#include <optional>

#include "tandem/coordination/datagram.h"
#include "tandem/plugin/address.h"

#pragma GCC visibility push(default)
namespace tandem::net {

/// Interface to send datagrams: a socket, or a simulated network.
class Outlet {
 public:
  virtual ~Outlet() = default;
  /// Never blocks. A datagram that cannot be sent is lost, as on any network.
  virtual void send(ByteView datagram, const Address& to) noexcept = 0;
};

/// Interface to send and take datagrams without blocking: a UDP socket, or a carrier.
class Socket : public Outlet {
 public:
  struct Received {
    std::size_t size = 0;  ///< 0 for a datagram without bytes
    Address from;
  };
  /// Takes the next datagram; empty if there is none. Cuts one longer than `room`.
  [[nodiscard]] virtual std::optional<Received> receive(ByteSpan room) noexcept = 0;

  /// Waits for a datagram, at most `seconds`.
  virtual void wait(double seconds) const noexcept = 0;

  [[nodiscard]] virtual Address bound() const noexcept = 0;
};

/// A non-blocking UDP socket for IPv6 and IPv4. It never fragments datagrams. Its buffers are
/// small, because a datagram that cannot be sent or taken at once is too old.
class UdpSocket final : public Socket {
 public:
  /// Binds the socket. Throws std::invalid_argument in one line with the remedy if the address is
  /// in use or not local. Throws tandem::Error if the system gives no socket.
  explicit UdpSocket(const Address& bind);
  ~UdpSocket() override;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  void send(ByteView datagram, const Address& to) noexcept override;
  [[nodiscard]] std::optional<Received> receive(ByteSpan room) noexcept override;
  void wait(double seconds) const noexcept override;

  /// File descriptor, for poll() on several sockets.
  [[nodiscard]] int handle() const noexcept { return socket_; }

  /// True on a machine without IPv6.
  [[nodiscard]] bool isIpv4() const noexcept { return is_ipv4_; }

  [[nodiscard]] Address bound() const noexcept override;
  [[nodiscard]] std::uint64_t unsent() const noexcept { return unsent_; }

 private:
  int socket_ = -1;
  bool is_ipv4_ = false;
  std::uint64_t unsent_ = 0;
};

}  // namespace tandem::net
#pragma GCC visibility pop
