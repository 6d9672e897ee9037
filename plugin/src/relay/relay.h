#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tandem/plugin/relay.h"
#include "tandem/plugin/secret_key.h"
#include "tandem/plugin/udp_socket.h"

#include "net/retry.h"
#include "relay/members.h"
#include "relay/relay_counts.h"
#include "secure/cookie.h"

namespace tandem::relay {

/// Forwards datagrams among the members of rooms. It needs no socket and no clock: the caller
/// passes bytes, addresses and time.
///
///   HELLO --tag--> COOKIE --> JOIN --tag, cookie--> JOINED --> KEEP, FORWARD ... --> LEAVE,
///   silence
///
/// It keeps nothing for strangers, and takes all memory when it is made. What members say to each
/// other it can neither read nor make: it sees headers only. One thread.
class Relay {
 public:
  /// Throws std::invalid_argument for settings out of range. `outlet` must outlive this.
  Relay(const RelaySettings& settings, SecretKey key, net::Outlet& outlet);

  /// Handles a datagram; may change its bytes.
  void receive(ByteSpan datagram, const Address& from, double now) noexcept;
  /// Removes silent members and checks addresses. For each poll; it acts 100 times a second.
  void advance(double now) noexcept;

  [[nodiscard]] const RelayCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] const Members& members() const noexcept { return members_; }

 private:
  [[nodiscard]] Result handle(ByteSpan datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Result handleRequest(ByteView datagram, const Address& from, double now) noexcept;
  [[nodiscard]] Result answerHello(const Request& hello, const Address& from, double now) noexcept;
  [[nodiscard]] Result admit(const Request& join, const Address& from, double now) noexcept;
  [[nodiscard]] Result handleSession(Type type, ByteSpan datagram, const Address& from,
                                     double now) noexcept;
  [[nodiscard]] Result forward(Member& member, ByteSpan datagram, double now) noexcept;
  [[nodiscard]] Result handleOwn(Member& member, ByteView datagram, std::uint64_t number,
                                 double now) noexcept;
  [[nodiscard]] bool deliver(Room& room, std::uint16_t to, ByteView datagram) noexcept;
  void answerKeep(Member& member, std::uint64_t number, std::uint16_t asked) noexcept;
  void begin(Member& member, const Request& join, const Address& from, double now) noexcept;
  void sendJoined(const Member& member, const Address& to) noexcept;
  void refuse(const Caller& caller, Code code, const Address& to, double now) noexcept;
  void challenge(Member& member, double now) noexcept;
  [[nodiscard]] secure::CookieSubject makeSubject(const Request& request,
                                                  const Address& from) const noexcept;

  SecretKey key_, address_key_;
  net::Outlet& outlet_;
  secure::CookieMaker cookies_;
  Members members_;
  double datagram_rate_, byte_rate_;
  net::RateLimit refusals_;
  RelayCounts counts_;
  double next_look_ = 0.0;
};

}  // namespace tandem::relay
