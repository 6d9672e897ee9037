#pragma once

#include <array>
#include <cstdint>
#include <string>

#pragma GCC visibility push(default)
namespace tandem {

/// Source or destination of a datagram. IPv4 is stored as mapped IPv6, ::ffff:a.b.c.d.
struct Address {
  std::array<std::uint8_t, 16> ip{};
  std::uint16_t port = 0;
  std::uint32_t scope = 0;  ///< interface of a link-local IPv6 address

  [[nodiscard]] friend bool operator==(const Address& a, const Address& b) noexcept {
    return a.ip == b.ip && a.port == b.port && a.scope == b.scope;
  }
  [[nodiscard]] friend bool operator!=(const Address& a, const Address& b) noexcept {
    return !(a == b);
  }
};

/// Text "10.0.0.2:7001" or "[fe80::1%3]:7001".
[[nodiscard]] std::string toString(const Address& address);

/// Resolves "host:port", "[ipv6]:port" or ":port". The latter means this machine, or all its
/// interfaces for `--bind`. Uses the system's resolver and may take seconds. Throws
/// std::invalid_argument in one line if the text is no address or the host is unknown.
[[nodiscard]] Address resolveAddress(const std::string& text);

}  // namespace tandem
#pragma GCC visibility pop
