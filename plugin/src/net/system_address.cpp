#include "net/system_address.h"

#include <algorithm>
#include <cstring>

namespace tandem::net {
namespace {

constexpr std::array<std::uint8_t, 12> kMappedIpv4 = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

}  // namespace

bool isMappedIpv4(const Address& address) noexcept {
  return std::equal(kMappedIpv4.begin(), kMappedIpv4.end(), address.ip.begin());
}

bool isAny(const Address& address) noexcept {
  return std::all_of(address.ip.begin(), address.ip.end(), [](auto byte) { return byte == 0; });
}

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

}  // namespace tandem::net
