#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tandem/coordination/link_plan.h"
#include "tandem/plugin/udp_socket.h"

#include "link/link_tally.h"
#include "terminal/stop_signals.h"

namespace tandem::demos {

struct LinkProxySettings {
  Address listen;   ///< address that the client sends to
  Address forward;  ///< address of the server
  LinkSettings start;
  std::vector<LinkChange> changes;
};

/// A bad link between two programs that use UDP. The client is the last sender to `listen`, at its
/// latest address. The server sees the proxy's second socket, as it would see a NAT. Takes
/// datagrams of up to kLongest bytes, at most kCapacity of them under way in each direction. Not
/// thread safe.
class LinkProxy {
 public:
  static constexpr std::size_t kLongest =
      1500;  ///< longest datagram [bytes], as an Ethernet carries
  static constexpr std::size_t kCapacity = 8192;  ///< 8 s of 1 kHz

  /// Binds. Throws std::invalid_argument, in one line, for a bad address, one in use, or a server
  /// that is the proxy itself; tandem::Error if the system gives no socket.
  explicit LinkProxy(const LinkProxySettings& settings);

  /// Passes datagrams on until `stop` is asked or `duration` [s] has passed.
  void run(const StopSignals& stop, double duration);

  /// Account of one direction.
  struct Lane {
    explicit Lane(Direction of) : direction(of), channel(of, kCapacity, kLongest) {}
    Direction direction;
    DatagramChannel channel;
    LinkTally tally;
    std::uint64_t not_passed_on = 0;  ///< refused by the system
  };

  [[nodiscard]] Address bound() const noexcept { return listen_.bound(); }
  [[nodiscard]] const Lane& lane(Direction direction) const noexcept {
    return direction == Direction::kForward ? forward_ : back_;
  }
  [[nodiscard]] double elapsed() const noexcept { return elapsed_; }  ///< time in run() [s]
  /// Datagrams to the second socket from senders other than the server.
  [[nodiscard]] std::uint64_t strangers() const noexcept { return strangers_; }

 private:
  void takeIn() noexcept;
  void enter(Lane& lane, std::size_t size, double now) noexcept;
  void passOn(Lane& lane, net::UdpSocket& socket, const Address& to) noexcept;
  void wait(const StopSignals& stop, double until) const noexcept;
  [[nodiscard]] double now() const noexcept;

  net::UdpSocket listen_;
  std::unique_ptr<net::UdpSocket> outward_;  ///< replaced by a rebind
  Address server_;
  Address client_;  ///< port 0: no client has sent yet
  LinkPlan plan_;
  Lane forward_{Direction::kForward}, back_{Direction::kBack};
  std::uint64_t strangers_ = 0;
  double started_ = 0.0, elapsed_ = 0.0;           // [s]
  std::array<std::uint8_t, kLongest + 1> room_{};  ///< one more byte, to detect longer ones
};

}  // namespace tandem::demos
