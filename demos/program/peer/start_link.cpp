#include "peer/start_link.h"

#include <algorithm>

namespace tandem::demos {

void StartLink::sendHeld(const PointState& user, PeerId self) noexcept {
  StatePacket packet;
  packet.sender = self;
  packet.user = user;
  sendStamped(packet, start_ ? kBefore + clock_ - *start_ : 0.0);
}

void StartLink::listenForStart(double delay) noexcept {
  while (const auto arrival = link_.receive(0.0, clock_)) {
    if (start_ || arrival->packet.time == 0.0) continue;
    start_ = arrival->time - delay - (arrival->packet.time - kBefore);
  }
}

void StartLink::send(const StatePacket& packet, double now) noexcept {
  sendStamped(packet, kBefore + now);
}

void StartLink::sendStamped(StatePacket packet, double time) noexcept {
  packet.time = time;
  packet.sequence = sequence_++;
  link_.send(packet, clock_);
}

std::optional<Arrival> StartLink::receive(double from, double until) noexcept {
  if (!start_) return std::nullopt;
  for (;;) {
    auto arrival = link_.receive(from + *start_, until + *start_);
    if (!arrival) return std::nullopt;
    if (arrival->packet.time < kBefore) continue;  // still holding
    arrival->packet.time -= kBefore;
    arrival->time = std::max(arrival->time - *start_, from);
    return arrival;
  }
}

}  // namespace tandem::demos
