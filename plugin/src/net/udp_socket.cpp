#include "tandem/plugin/udp_socket.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <poll.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

#include "net/system_address.h"

namespace tandem::net {
namespace {

/// Room for some hundred datagrams; a tick takes at most 128 [bytes].
constexpr int kBufferSize = 256 * 1024;

void setOption(int socket, int level, int name, int value) noexcept {
  // The options are useful but not necessary, so errors are ignored.
  (void)setsockopt(socket, level, name, &value, sizeof value);
}

[[noreturn]] void throwNotBound(const Address& address, int error) {
  std::string message = "cannot bind to " + toString(address) + ": " + std::strerror(error);
  if (error == EADDRINUSE)
    message += "; choose another port, or end the program that has it";
  else if (error == EADDRNOTAVAIL)
    message += "; choose an address of this machine, or leave it away: \":port\"";
  else if (error == EACCES)
    message += "; choose a port from 1024 up";
  throw std::invalid_argument(message);
}

}  // namespace

UdpSocket::UdpSocket(const Address& bind_to) {
  socket_ = ::socket(AF_INET6, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) {
    if (!isMappedIpv4(bind_to) && !isAny(bind_to))
      throw Error(std::string("cannot open an IPv6 socket: ") + std::strerror(errno));
    is_ipv4_ = true;
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  }
  if (socket_ < 0) throw Error(std::string("cannot open a UDP socket: ") + std::strerror(errno));
  if (!is_ipv4_) setOption(socket_, IPPROTO_IPV6, IPV6_V6ONLY, 0);
  setOption(socket_, SOL_SOCKET, SO_RCVBUF, kBufferSize);
  setOption(socket_, SOL_SOCKET, SO_SNDBUF, kBufferSize);
  setOption(socket_, IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_PROBE);
  if (!is_ipv4_) setOption(socket_, IPPROTO_IPV6, IPV6_MTU_DISCOVER, IPV6_PMTUDISC_PROBE);
  const SystemAddress address = toSystem(bind_to, is_ipv4_);
  if (::bind(socket_, address.get(), address.size) != 0) {
    const int error = errno;
    ::close(socket_);
    throwNotBound(bind_to, error);
  }
}

UdpSocket::~UdpSocket() { ::close(socket_); }

void UdpSocket::send(ByteView datagram, const Address& to) noexcept {
  if (is_ipv4_ && !isMappedIpv4(to)) {  // unreachable from a machine without IPv6
    ++unsent_;
    return;
  }
  const SystemAddress address = toSystem(to, is_ipv4_);
  const ssize_t sent =
      ::sendto(socket_, datagram.data, datagram.size, 0, address.get(), address.size);
  if (sent < 0) ++unsent_;
}

std::optional<UdpSocket::Received> UdpSocket::receive(ByteSpan room) noexcept {
  sockaddr_storage storage{};
  // An error of an earlier send (no such port) does not concern the waiting datagrams.
  for (int tries = 0; tries < 8; ++tries) {
    socklen_t size = sizeof storage;
    const ssize_t got =
        ::recvfrom(socket_, room.data, room.size, 0, reinterpret_cast<sockaddr*>(&storage), &size);
    if (got >= 0) return Received{static_cast<std::size_t>(got), fromSystem(storage)};
    if (errno == EAGAIN || errno == EWOULDBLOCK) return std::nullopt;
  }
  return std::nullopt;
}

void UdpSocket::wait(double seconds) const noexcept {
  pollfd wanted{socket_, POLLIN, 0};
  const double most = std::clamp(seconds, 0.0, 3600.0);
  timespec time{};
  time.tv_sec = static_cast<time_t>(most);
  time.tv_nsec = static_cast<long>((most - static_cast<double>(time.tv_sec)) * 1e9);
  (void)::ppoll(&wanted, 1, &time, nullptr);
}

Address UdpSocket::bound() const noexcept {
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;
  (void)::getsockname(socket_, reinterpret_cast<sockaddr*>(&storage), &size);
  return fromSystem(storage);
}

}  // namespace tandem::net
