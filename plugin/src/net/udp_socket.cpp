#include "tandem/plugin/udp_socket.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

namespace tandem::net {
namespace {

/// Room for some hundred datagrams; a tick takes at most 128 [bytes].
constexpr int kBufferSize = 256 * 1024;

constexpr std::array<std::uint8_t, 12> kMappedIpv4 = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

bool isMappedIpv4(const Address& address) noexcept {
  return std::equal(kMappedIpv4.begin(), kMappedIpv4.end(), address.ip.begin());
}

bool isAny(const Address& address) noexcept {
  return std::all_of(address.ip.begin(), address.ip.end(), [](auto byte) { return byte == 0; });
}

/// An address in the form of the system's calls.
struct SystemAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;
  [[nodiscard]] const sockaddr* get() const noexcept {
    return reinterpret_cast<const sockaddr*>(&storage);
  }
};

SystemAddress toSystem(const Address& address, bool is_ipv4) noexcept {
  SystemAddress system;
  if (is_ipv4) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_port = htons(address.port);
    std::memcpy(&in.sin_addr, address.ip.data() + kMappedIpv4.size(), sizeof in.sin_addr);
    std::memcpy(&system.storage, &in, sizeof in);
    system.size = sizeof in;
    return system;
  }
  sockaddr_in6 in{};
  in.sin6_family = AF_INET6;
  in.sin6_port = htons(address.port);
  in.sin6_scope_id = address.scope;
  std::memcpy(&in.sin6_addr, address.ip.data(), sizeof in.sin6_addr);
  std::memcpy(&system.storage, &in, sizeof in);
  system.size = sizeof in;
  return system;
}

Address fromSystem(const sockaddr_storage& storage) noexcept {
  Address address;
  if (storage.ss_family == AF_INET) {
    sockaddr_in in{};
    std::memcpy(&in, &storage, sizeof in);
    std::copy(kMappedIpv4.begin(), kMappedIpv4.end(), address.ip.begin());
    std::memcpy(address.ip.data() + kMappedIpv4.size(), &in.sin_addr, sizeof in.sin_addr);
    address.port = ntohs(in.sin_port);
    return address;
  }
  sockaddr_in6 in{};
  std::memcpy(&in, &storage, sizeof in);
  std::memcpy(address.ip.data(), &in.sin6_addr, sizeof in.sin6_addr);
  address.port = ntohs(in.sin6_port);
  address.scope = in.sin6_scope_id;
  return address;
}

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
