#include "link/link_proxy.h"

#include <algorithm>
#include <cerrno>
#include <limits>
#include <stdexcept>

#include <poll.h>
#include <sys/prctl.h>

#include "tandem/falcon/monotonic_clock.h"

//                   enter: now                     due <= now
//  client --> listen_ -----> forward_ (heap) ------------> outward_ --> server
//  client <-- listen_ <------------ back_ (heap) <-------- outward_ <-- server
//
// One thread. It sleeps in ppoll() until a datagram comes, one is due, the plan has a change or a
// signal asks to stop.

namespace tandem::demos {
namespace {

/// A flood of new datagrams must not delay those that are due.
constexpr int kMostPerRound = 16;

bool isAny(const Address& address) noexcept {
  return std::all_of(address.ip.begin(), address.ip.end(), [](auto byte) { return byte == 0; });
}

/// True for 127.0.0.0/8 and ::1.
bool isLoopback(const Address& address) noexcept {
  const Address loopback6 = {{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, address.port, 0};
  const bool is_mapped = std::all_of(address.ip.begin(), address.ip.begin() + 10,
                                     [](auto byte) { return byte == 0; }) &&
                         address.ip[10] == 0xff && address.ip[11] == 0xff;
  return address == loopback6 || (is_mapped && address.ip[12] == 127);
}

/// ":port" is a server on this machine. Answers come from an address, so one is needed.
Address serverOf(const Address& forward) {
  if (forward.port == 0)
    throw std::invalid_argument("--forward " + toString(forward) +
                                ": must have the port of the server, 1 to 65535");
  if (!isAny(forward)) return forward;
  Address here = forward;
  here.ip = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff, 127, 0, 0, 1};
  return here;
}

}  // namespace

LinkProxy::LinkProxy(const LinkProxySettings& settings)
    : listen_(settings.listen),
      outward_(std::make_unique<net::UdpSocket>(Address{})),
      server_(serverOf(settings.forward)),
      plan_(settings.start, settings.changes) {
  const Address own = listen_.bound();
  if (server_.port == own.port && (server_.ip == own.ip || (isAny(own) && isLoopback(server_))))
    throw std::invalid_argument("--forward " + toString(server_) +
                                ": is what --listen has; must be the address of the server");
}

double LinkProxy::now() const noexcept { return readMonotonicClock() - started_; }

void LinkProxy::run(const StopSignals& stop, double duration) {
  // The default timer slack of 50 us, which saves power, would make timers late.
  (void)prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  started_ = readMonotonicClock();
  for (double time = 0.0; !stop.isAsked() && time < duration; time = now()) {
    if (plan_.advance(time) > 0) outward_ = std::make_unique<net::UdpSocket>(Address{});
    takeIn();
    passOn(forward_, *outward_, server_);
    passOn(back_, listen_, client_);
    wait(stop, std::min({plan_.nextChange(), forward_.channel.nextDue(), back_.channel.nextDue(),
                         duration}));
  }
  elapsed_ = now();
}

void LinkProxy::takeIn() noexcept {
  for (int i = 0; i < kMostPerRound; ++i) {
    const auto received = listen_.receive({room_.data(), room_.size()});
    if (!received) break;
    client_ = received->from;
    enter(forward_, received->size, now());
  }
  for (int i = 0; i < kMostPerRound; ++i) {
    const auto received = outward_->receive({room_.data(), room_.size()});
    if (!received) break;
    if (received->from == server_) {
      enter(back_, received->size, now());
    } else {
      ++strangers_;
    }
  }
}

void LinkProxy::enter(Lane& lane, std::size_t size, double now) noexcept {
  const ChannelConditions conditions = conditionsOf(plan_.settings(), lane.direction);
  lane.tally.noteSent(conditions, lane.channel.send({room_.data(), size}, conditions, now));
}

void LinkProxy::passOn(Lane& lane, net::UdpSocket& socket, const Address& to) noexcept {
  while (const auto delivery = lane.channel.takeDue(now())) {
    const std::uint64_t unsent = socket.unsent();
    socket.send(delivery->bytes, to);
    lane.not_passed_on += socket.unsent() - unsent;
    lane.tally.noteDelivered(*delivery, now());
  }
}

void LinkProxy::wait(const StopSignals& stop, double until) const noexcept {
  pollfd sockets[] = {{listen_.handle(), POLLIN, 0}, {outward_->handle(), POLLIN, 0}};
  const double most = std::clamp(until - now(), 0.0, 3600.0);
  timespec time{};
  time.tv_sec = static_cast<time_t>(most);
  time.tv_nsec = static_cast<long>((most - static_cast<double>(time.tv_sec)) * 1e9);
  (void)ppoll(sockets, 2, &time, &stop.whileWaiting());
}

}  // namespace tandem::demos
