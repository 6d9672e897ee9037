#pragma once

#include <vector>

#include "tandem/coordination/link.h"

namespace tandem::test {

/// A link whose end here uses a clock that is `ahead` [s] of the link's own.
class ShiftedLink final : public Link {
 public:
  ShiftedLink(Link& link, double ahead) : link_(link), ahead_(ahead) {}

  void send(const StatePacket& packet, double now) noexcept override {
    stamps.push_back(now);
    link_.send(packet, now - ahead_);
  }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override {
    auto arrival = link_.receive(from - ahead_, until - ahead_);
    if (arrival) arrival->time += ahead_;
    return arrival;
  }

  std::vector<double> stamps;  ///< send times of states, by the clock here [s]

 private:
  Link& link_;
  double ahead_;
};

}  // namespace tandem::test
