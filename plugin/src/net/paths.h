#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tandem/plugin/address.h"

#include "coordination/src/wire/wire.h"

namespace tandem::net {

/// Addresses at which a peer may be, and the one in use. Sealing and sending is the caller's part.
///
/// The source of an authentic datagram proves nothing: a listener may send copies of it from
/// elsewhere. So the address in use stays as long as the peer answers a challenge that was sent
/// there. It is given up for one that answers while it does not:
///
///   datagram from elsewhere --> challenge all --in use answers--> stay
///                                             --only another answers--> move there
///
/// This is path validation of QUIC (RFC 9000, section 9), with both paths probed.
///
/// With a relay all are challenged once a second. Between the relay and a direct address the one
/// that answers first is taken, if it does so three times in a row. Real-time safe.
class Paths {
 public:
  /// A challenge to be sent.
  struct Challenge {
    Address to;
    PathToken token = 0;
  };
  static constexpr std::size_t kMost = 5;
  using Challenges = std::array<std::optional<Challenge>, kMost>;
  /// Addresses that are called: in use, configured, relayed; each once.
  using Calls = std::array<std::optional<Address>, 3>;

  /// `relayed`: the address that means "through the relay"; empty without a relay.
  explicit Paths(const std::optional<Address>& configured,
                 const std::optional<Address>& relayed = std::nullopt) noexcept;

  [[nodiscard]] const std::optional<Address>& inUse() const noexcept { return in_use_; }
  [[nodiscard]] Calls calls() const noexcept;
  /// With a relay another address at which the peer answered lately; else empty.
  [[nodiscard]] std::optional<Address> spare(double now) const noexcept;
  [[nodiscard]] bool knows(const Address& address) const noexcept {
    return in_use_ == address || configured_ == address || relayed_ == address;
  }
  [[nodiscard]] std::uint64_t moves() const noexcept { return moves_; }

  /// Remembers an address: of a datagram that may be a copy, or that somebody tells.
  void hear(const Address& from) noexcept;
  /// Takes the source of a new authentic datagram: the first is used at once, another is checked.
  void note(const Address& from, double now) noexcept;
  /// Checks whether the peer is still there, if another address is known.
  void check(double now) noexcept;
  /// Takes a response from anywhere.
  void onResponse(PathToken token, double now) noexcept;

  /// Decides the check if it is over. Returns the challenges that are due.
  [[nodiscard]] Challenges advance(double now, double round_trip) noexcept;

 private:
  struct Path {
    Address address;
    PathToken token = 0;                        ///< 0: never challenged
    bool has_answered = false;                  ///< in this check
    std::optional<double> trip = std::nullopt;  ///< of the fastest answers so far, see kSlower [s]
    double answered_at = 0.0;                   ///< last time [s]
  };

  [[nodiscard]] Path* find(const Address& address) noexcept;
  void forgetSilent() noexcept;
  [[nodiscard]] const Path* findBetter(const Path& used) const noexcept;
  void settle(const Path& used, double now) noexcept;
  void finish(double now) noexcept;
  void moveTo(const Address& address, double now) noexcept;

  std::optional<Address> configured_, relayed_;
  std::optional<Address> in_use_;
  std::array<std::optional<Path>, kMost> paths_;
  std::size_t next_place_ = 0;
  std::uint64_t moves_ = 0;

  bool is_checking_ = false;
  double since_ = 0.0, next_ = 0.0, wait_ = 0.0;
  double rest_until_ = 0.0;

  std::optional<Address> winner_;  ///< faster than the address in use
  int wins_ = 0;                   ///< in a row
};

}  // namespace tandem::net
