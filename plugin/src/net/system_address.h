#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include "tandem/plugin/address.h"

/// \file
/// Addresses in the form of the system's calls.
namespace tandem::net {

struct SystemAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;
  [[nodiscard]] const sockaddr* get() const noexcept {
    return reinterpret_cast<const sockaddr*>(&storage);
  }
};

[[nodiscard]] bool isMappedIpv4(const Address& address) noexcept;
/// True for the address of all interfaces.
[[nodiscard]] bool isAny(const Address& address) noexcept;

/// `is_ipv4`: for a socket of a machine without IPv6.
[[nodiscard]] SystemAddress toSystem(const Address& address, bool is_ipv4) noexcept;
[[nodiscard]] Address fromSystem(const sockaddr_storage& storage) noexcept;

}  // namespace tandem::net
