#include "tandem/plugin/address.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>

namespace tandem {
namespace {

constexpr const char* kForm = "; give host:port, [IPv6]:port or :port";

struct HostAndPort {
  std::string host, port;
};

[[noreturn]] void throwNoAddress(const std::string& text, const std::string& why) {
  throw std::invalid_argument("\"" + text + "\" is no address: " + why + kForm);
}

HostAndPort split(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) throwNoAddress(text, "the port is missing");
  HostAndPort parts{text.substr(0, colon), text.substr(colon + 1)};
  if (!parts.host.empty() && parts.host.front() == '[') {
    if (parts.host.back() != ']') throwNoAddress(text, "a bracket is missing");
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  } else if (parts.host.find(':') != std::string::npos) {
    throwNoAddress(text, "an IPv6 address needs brackets");
  }
  const bool is_number = !parts.port.empty() && parts.port.size() <= 5 &&
                         std::all_of(parts.port.begin(), parts.port.end(),
                                     [](char c) { return c >= '0' && c <= '9'; });
  if (!is_number || std::stoi(parts.port) > 65535)
    throwNoAddress(text, "the port must be 0 to 65535");
  return parts;
}

}  // namespace

std::string toString(const Address& address) {
  char host[INET6_ADDRSTRLEN] = "?";
  in6_addr ip{};
  std::memcpy(&ip, address.ip.data(), sizeof ip);
  const std::string port = ":" + std::to_string(address.port);
  if (IN6_IS_ADDR_V4MAPPED(&ip)) {
    (void)inet_ntop(AF_INET, address.ip.data() + 12, host, sizeof host);
    return host + port;
  }
  (void)inet_ntop(AF_INET6, &ip, host, sizeof host);
  const std::string scope = address.scope != 0 ? "%" + std::to_string(address.scope) : "";
  return "[" + std::string(host) + scope + "]" + port;
}

Address resolveAddress(const std::string& text) {
  const HostAndPort parts = split(text);
  Address address;
  address.port = static_cast<std::uint16_t>(std::stoi(parts.port));
  if (parts.host.empty()) return address;
  addrinfo hints{};
  hints.ai_family = AF_INET6;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_V4MAPPED | AI_ALL;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(parts.host.c_str(), nullptr, &hints, &found);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  if (error != 0 || !found)
    throw std::invalid_argument("host \"" + parts.host + "\" is not known (" + gai_strerror(error) +
                                "); check its name" + kForm);
  // Prefer IPv4: most networks between two sites support it.
  const addrinfo* best = found;
  for (const addrinfo* one = found; one; one = one->ai_next) {
    const auto* in = reinterpret_cast<const sockaddr_in6*>(one->ai_addr);
    if (IN6_IS_ADDR_V4MAPPED(&in->sin6_addr)) {
      best = one;
      break;
    }
  }
  sockaddr_in6 in{};
  std::memcpy(&in, best->ai_addr, sizeof in);
  std::memcpy(address.ip.data(), &in.sin6_addr, address.ip.size());
  address.scope = in.sin6_scope_id;
  return address;
}

}  // namespace tandem
