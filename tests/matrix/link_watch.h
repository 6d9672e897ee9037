#pragma once

#include <algorithm>
#include <functional>

#include "tandem/coordination/link.h"

namespace tandem::test {

/// Passes all packets on between a site and a link, and notes the age of states that come out.
class LinkWatch final : public Link {
 public:
  /// Called for each state that comes out, with its send and arrival times by one clock [s].
  using Note = std::function<void(double sent, double came)>;

  /// `sender_ahead` is the sender's clock minus the receiver's [s].
  LinkWatch(Link& link, double sender_ahead, Note note)
      : link_(link), sender_ahead_(sender_ahead), note_(std::move(note)) {}

  void send(const StatePacket& packet, double now) noexcept override { link_.send(packet, now); }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override {
    auto arrival = link_.receive(from, until);
    if (arrival) note_(arrival->packet.time - sender_ahead_, arrival->time);
    return arrival;
  }

 private:
  Link& link_;
  double sender_ahead_;
  Note note_;
};

}  // namespace tandem::test
