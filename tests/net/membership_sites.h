#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "net/mesh.h"

namespace tandem::test {

/// Two or three sites, a network that does what it is told, and what must hold whatever that is:
///
/// - nothing is sealed twice under one number and key, and nothing that was sealed is taken twice;
/// - nothing that was changed on its way is taken, as far as seal and handshake cover it;
/// - a site is given states as they were sent, in rising order, by peers with its key and
///   configuration only;
/// - each datagram that came in is counted once.
///
/// Times are multiples of 1/1024 s, so that sums are exact and a timeout can be met to the bit.
class MembershipSites {
 public:
  static constexpr double kStep = 1.0 / 1024;         // [s]
  static constexpr double kDelay = 20 * kStep;        ///< of the network when it is perfect [s]
  static constexpr double kStatePeriod = 8 * kStep;   // [s]
  static constexpr std::size_t kMostInFlight = 1000;  ///< beyond, the oldest are lost

  /// How a site is started. Sites with unequal keys or configurations must not meet.
  struct Start {
    std::uint8_t key = 0, configuration = 0;
    double clock = 0.0;  ///< what its clock shows [s]
    friend bool operator==(const Start&, const Start&) = default;
    [[nodiscard]] bool mayMeet(const Start& other) const noexcept {
      return key == other.key && configuration == other.configuration;
    }
  };

  explicit MembershipSites(std::size_t count);

  void start(std::size_t site, const Start& how);
  void stop(std::size_t site);
  void leave(std::size_t site, ByeReason reason);
  /// As a NAT does; 0: back to where the others were told that it is.
  void rebind(std::size_t site, std::uint16_t shift);

  /// Time passes, and nobody notices until act().
  void pass(double seconds) { now_ += seconds; }
  /// The sites of this bit mask say what is due, send a state, and take what was given to them.
  void act(unsigned mask);
  /// What would happen with a network without faults.
  void runPerfectly(double seconds);

  // One of the datagrams in flight.
  void deliver(std::size_t which);
  void drop(std::size_t which);
  void repeat(std::size_t which);
  /// Some byte of it is changed (`turn` is not 0), and that is delivered.
  void change(std::size_t which, std::size_t at, std::uint8_t turn);
  void cut(std::size_t which, std::size_t size);
  /// Delivers one that was delivered before; from elsewhere if asked.
  void replay(std::size_t which, bool is_from_stranger);
  /// Some bytes, from nowhere.
  void forge(std::size_t site, std::vector<std::uint8_t> bytes);

  /// Stops and starts whatever would not be live by itself.
  void mend();
  /// All are live, and each was given a state of each other since mend().
  [[nodiscard]] bool areTogether() const;

  [[nodiscard]] std::size_t count() const noexcept { return sites_.size(); }
  /// What did not hold first; empty: nothing.
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
    std::unique_ptr<net::Mesh> mesh;
    Start how;
    double ahead = 0.0;  ///< its clock - now [s]
    bool has_left = false;
    std::uint64_t states = 0;
    std::array<std::optional<std::uint64_t>, 4> newest;  ///< given, by peer id
    std::array<std::uint64_t, 4> given{};
    std::array<bool, 4> is_given_since_mended{};
  };

  static Address addressOf(std::size_t site);
  static StatePacket makeState(std::size_t site, const Start& how, std::uint64_t number);

  void carry(std::size_t from, ByteView bytes, const Address& to);
  /// Whether it was taken.
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
