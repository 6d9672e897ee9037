#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"

#include "link/packet_fates.h"

namespace tandem {
namespace {

constexpr double kPeriod = 0.001;  // haptic period [s]

/// One copy of a packet on its way.
struct Copy {
  std::uint64_t number;
  double sent;
  double arrival;
};

/// The simplest link that keeps the promises of Link::receive(): a list that is searched and sorted
/// anew in every tick. Each packet's travel time is known beforehand.
class PlainLink {
 public:
  explicit PlainLink(std::vector<Fate> fates) : fates_(std::move(fates)) {}

  void send(std::uint64_t number, double now) {
    for (const double arrival : fates_.at(number)) {
      const double observed_at =
          static_cast<double>(number);  // time at which its fate was observed
      const bool at_once = arrival == observed_at + kEarliest;
      on_the_way_.push_back({number, now, at_once ? now : now + (arrival - observed_at)});
    }
  }

  std::vector<Copy> receiveAll(double from, double until) {
    const auto first =
        std::stable_partition(on_the_way_.begin(), on_the_way_.end(),
                              [=](const Copy& c) { return !(c.arrival < until && c.sent < from); });
    std::vector<Copy> taken(first, on_the_way_.end());
    on_the_way_.erase(first, on_the_way_.end());
    std::stable_sort(taken.begin(), taken.end(),
                     [](const Copy& a, const Copy& b) { return a.arrival < b.arrival; });
    for (Copy& copy : taken) copy.arrival = std::max(copy.arrival, from);
    return taken;
  }

 private:
  std::vector<Fate> fates_;
  std::vector<Copy> on_the_way_;  // ordered as sent
};

// Up to three packets in a tick, some in its middle, over a way with all impairments at once.
TEST(LinkOrder, AgreesWithAListThatIsSearchedAndSorted) {
  constexpr std::uint64_t kPackets = 3000;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Impairments impairments{0.0023, 0.004, 0.2, 0.3, 0.3, seed};
    const auto [a, b] = makeSimulatedLinks(impairments);
    PlainLink plain(observeFates(impairments, kPackets));
    std::mt19937_64 engine(seed);

    std::uint64_t number = 0, delivered = 0, late = 0;
    for (std::uint64_t tick = 0; number + 3 <= kPackets; ++tick) {
      const double from = static_cast<double>(tick) * kPeriod;
      const double until = static_cast<double>(tick + 1) * kPeriod;
      for (std::uint64_t i = engine() % 4; i > 0; --i, ++number) {
        const double now = engine() % 2 == 0 ? from : from + 0.3 * kPeriod;
        a->send(makePacket(number), now);
        plain.send(number, now);
      }
      const std::vector<Arrival> arrivals = receiveAll(*b, from, until);
      const std::vector<Copy> expected = plain.receiveAll(from, until);
      ASSERT_EQ(arrivals.size(), expected.size()) << "tick " << tick;
      for (std::size_t i = 0; i < arrivals.size(); ++i) {
        EXPECT_EQ(arrivals[i].packet.sequence, expected[i].number) << "tick " << tick;
        // A travel time computed from a time of up to 3000 s is right within 5e-13 s.
        EXPECT_NEAR(arrivals[i].time, expected[i].arrival, 1e-12);
        if (arrivals[i].time == from) ++late;
      }
      delivered += arrivals.size();
    }
    EXPECT_EQ(a->counts().delivered, delivered);
    EXPECT_GT(delivered, kPackets * 9 / 10);  // 0.8 arrive, 1.3 times each
    EXPECT_GT(late, kPackets / 10);           // many waited for their tick
  }
}

// With jitter, packets arrive out of order, but arrival times never decrease.
TEST(LinkOrder, JitterReordersAndTimesStayInOrder) {
  const auto [a, b] = makeSimulatedLinks({0.05, 0.02, 0.0, 0.0, 0.0, 9});
  std::uint64_t overtaken = 0, newest = 0, received = 0, sent = 0;
  double latest = 0.0;
  for (std::uint64_t tick = 0; tick < 10000; ++tick) {
    const double from = static_cast<double>(tick) * kPeriod;
    for (const Arrival& arrival : receiveAll(*b, from, from + kPeriod)) {
      EXPECT_GE(arrival.time, latest);
      latest = arrival.time;
      if (arrival.packet.sequence < newest) ++overtaken;
      newest = std::max(newest, arrival.packet.sequence);
      ++received;
    }
    if (tick % 8 == 0) a->send(makePacket(sent++), from);
  }
  EXPECT_GE(received + 9, sent);  // at most 70 ms of packets are still on the way
  EXPECT_GT(overtaken, sent / 10);
}

}  // namespace
}  // namespace tandem
