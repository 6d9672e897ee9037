#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "net/peer_group.h"

namespace tandem::test {

/// Two or three sites on a scripted network, and the properties that must hold in any script:
///
/// - no number and key seal twice, and nothing sealed is accepted twice;
/// - no changed datagram is accepted, as far as seal and handshake cover it;
/// - a site gets states as they were sent, in rising order, only from peers with its key and
///   configuration;
/// - each incoming datagram is counted once.
///
/// Times are multiples of 1/1024 s, so sums are exact and a timeout can be hit exactly.
class MembershipSites {
 public:
  static constexpr double kStep = 1.0 / 1024;         // [s]
  static constexpr double kDelay = 20 * kStep;        ///< delay of the perfect network [s]
  static constexpr double kStatePeriod = 8 * kStep;   // [s]
  static constexpr std::size_t kMostInFlight = 1000;  ///< the oldest beyond this are lost

  /// Start parameters of a site. Sites with unequal keys or configurations must not connect.
  struct Start {
    std::uint8_t key = 0, configuration = 0;
    double clock = 0.0;  ///< start time of its clock [s]
    friend bool operator==(const Start&, const Start&) = default;
    [[nodiscard]] bool mayMeet(const Start& other) const noexcept {
      return key == other.key && configuration == other.configuration;
    }
  };

  explicit MembershipSites(std::size_t count);

  void start(std::size_t site, const Start& how);
  void stop(std::size_t site);
  void leave(std::size_t site, ByeReason reason);
  /// Changes a site's port, as a NAT does; 0 restores the address that the others were given.
  void rebind(std::size_t site, std::uint16_t shift);

  /// Lets time pass; no site runs until act().
  void pass(double seconds) { now_ += seconds; }
  /// Runs the sites in this bit mask: each sends due datagrams and a state, and takes its arrivals.
  void act(unsigned mask);
  /// Runs with a network without faults.
  void runPerfectly(double seconds);

  // Delivers one of the datagrams in flight.
  void deliver(std::size_t which);
  void drop(std::size_t which);
  void repeat(std::size_t which);
  /// Changes a byte of a datagram (`turn` is not 0), and delivers that.
  void change(std::size_t which, std::size_t at, std::uint8_t turn);
  void cut(std::size_t which, std::size_t size);
  /// Delivers an earlier datagram again, from a stranger's address if asked.
  void replay(std::size_t which, bool is_from_stranger);
  /// Delivers made-up bytes from an unknown address.
  void forge(std::size_t site, std::vector<std::uint8_t> bytes);

  /// Restarts each site that would not become live by itself.
  void mend();
  /// True if all are live, and each got a state of each other since mend().
  [[nodiscard]] bool areTogether() const;

  [[nodiscard]] std::size_t count() const noexcept { return sites_.size(); }
  /// The first property that failed; empty if none.
  [[nodiscard]] const std::string& broken() const noexcept { return broken_; }

 private:
  struct Port;
  struct Datagram {
    std::vector<std::uint8_t> bytes;
    Address from, to;
    double sent = 0.0;
    Start sender;
  };
  struct Site {
    Site();
    Site(Site&&) noexcept;
    ~Site();
    std::unique_ptr<Port> port;
    std::unique_ptr<net::PeerGroup> mesh;
    Start how;
    double ahead = 0.0;  ///< its clock minus now [s]
    bool has_left = false;
    std::uint64_t states = 0;
    std::array<std::optional<std::uint64_t>, 4> newest;  ///< newest state received, by peer id
    std::array<std::uint64_t, 4> given{};
    std::array<double, 4> granted{};  ///< by each peer, by its newest state [J]
    std::array<bool, 4> is_given_since_mended{};
  };

  static Address addressOf(std::size_t site);
  static StatePacket makeState(std::size_t site, const Start& how, std::uint64_t number);

  void carry(std::size_t from, ByteView bytes, const Address& to);
  /// Hands a datagram over; returns true if it was accepted.
  bool handOver(const Datagram& datagram);
  void handOverChanged(Datagram datagram, const std::vector<std::uint8_t>& as_it_was);
  Datagram takeOut(std::size_t which);
  void takeGiven(std::size_t site, std::size_t peer);
  void checkCounts(std::size_t site);
  void require(bool holds, const char* what) {
    if (!holds && broken_.empty()) broken_ = what;
  }
  [[nodiscard]] double clockOf(const Site& site) const noexcept { return now_ + site.ahead; }

  std::vector<Site> sites_;
  std::vector<Datagram> flying_, delivered_;
  std::set<std::vector<std::uint8_t>> sealed_, taken_;
  double now_ = 0.0;
  double state_at_ = 0.0;
  std::string broken_;
};

}  // namespace tandem::test
