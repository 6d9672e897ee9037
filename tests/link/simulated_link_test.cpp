#include "tandem/coordination/simulated_link.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "link/packet_fates.h"

namespace tandem {
namespace {

constexpr double kPeriod = 0.001;  // haptic period [s]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double tickTime(std::uint64_t tick) { return static_cast<double>(tick) * kPeriod; }

TEST(SimulatedLink, ConstantDelayIsExact) {
  Impairments impairments;
  impairments.delay = 0.05;
  const auto [a, b] = makeSimulatedLinks(impairments);
  std::uint64_t sent = 0, received = 0;
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    const double from = tickTime(tick), until = tickTime(tick + 1);
    for (const Arrival& arrival : receiveAll(*b, from, until)) {
      EXPECT_EQ(arrival.packet.sequence, received++);
      EXPECT_EQ(arrival.time, arrival.packet.time + 0.05);
      EXPECT_GE(arrival.time, from);
      EXPECT_LT(arrival.time, until);
    }
    for (; static_cast<double>(sent) / 128.0 < until; ++sent) {
      StatePacket packet = makePacket(sent);
      packet.time = static_cast<double>(sent) / 128.0;
      a->send(packet, packet.time);
    }
  }
  EXPECT_EQ(sent, 384U);
  EXPECT_EQ(received, 378U);  // those sent until 2.95 s
}

TEST(SimulatedLink, CarriesThePacketUnchanged) {
  StatePacket packet = makePacket(7);
  packet.sender = PeerId{3};
  packet.time = 1.25;
  packet.user = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  packet.object_count = 2;
  packet.objects[1].id = 9;
  packet.objects[1].state.q_WB = Quat(0.5, 0.5, -0.5, 0.5);

  const auto [a, b] = makeSimulatedLinks({});
  a->send(packet, 1.25);
  const auto arrival = b->receive(1.5, 2.0);
  ASSERT_TRUE(arrival.has_value());
  EXPECT_EQ(arrival->packet.sender, packet.sender);
  EXPECT_EQ(arrival->packet.sequence, packet.sequence);
  EXPECT_EQ(arrival->packet.time, packet.time);
  EXPECT_EQ(arrival->packet.user.p_W, packet.user.p_W);
  EXPECT_EQ(arrival->packet.user.v_W, packet.user.v_W);
  EXPECT_EQ(arrival->packet.object_count, 2U);
  EXPECT_EQ(arrival->packet.objects[1].id, 9U);
  EXPECT_EQ(arrival->packet.objects[1].state.q_WB.coeffs(), packet.objects[1].state.q_WB.coeffs());
}

TEST(SimulatedLink, PacketIsNeverTakenInTheTickItWasSentIn) {
  const auto [a, b] = makeSimulatedLinks({});  // no delay
  a->send(makePacket(0), tickTime(5));
  a->send(makePacket(1), tickTime(5) + 0.4 * kPeriod);
  EXPECT_TRUE(receiveAll(*b, tickTime(5), tickTime(6)).empty());

  const std::vector<Arrival> next = receiveAll(*b, tickTime(6), tickTime(7));
  ASSERT_EQ(next.size(), 2U);
  EXPECT_EQ(next[0].packet.sequence, 0U);
  EXPECT_EQ(next[1].packet.sequence, 1U);
  for (const Arrival& arrival : next) EXPECT_EQ(arrival.time, tickTime(6));  // not before the tick
}

// Packet 1 overtakes packet 0 but was sent in this tick. It waits, and packet 0 does not wait for
// it.
TEST(SimulatedLink, PacketThatHasToWaitHoldsUpNoOther) {
  Impairments impairments;
  impairments.delay = 1.5 * kPeriod;
  impairments.reorder = 0.5;
  const auto jumpsOnlySecond = [&impairments] {
    const std::vector<Fate> fates = observeFates(impairments, 2);
    return fates[0][0] > kEarliest && fates[1][0] == 1.0 + kEarliest;
  };
  while (!jumpsOnlySecond()) ++impairments.seed;

  const auto [a, b] = makeSimulatedLinks(impairments);
  a->send(makePacket(0), tickTime(0));
  EXPECT_TRUE(receiveAll(*b, tickTime(0), tickTime(1)).empty());
  a->send(makePacket(1), tickTime(1));
  const std::vector<Arrival> first = receiveAll(*b, tickTime(1), tickTime(2));
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].packet.sequence, 0U);
  EXPECT_EQ(first[0].time, 1.5 * kPeriod);
  const std::vector<Arrival> second = receiveAll(*b, tickTime(2), tickTime(3));
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].packet.sequence, 1U);
  EXPECT_EQ(second[0].time, tickTime(2));
}

// Equal arrivals come in the order of sending, for any order of heap operations.
TEST(SimulatedLink, EqualArrivalsKeepTheOrderOfSending) {
  const auto [a, b] = makeSimulatedLinks({});
  for (std::uint64_t n = 0; n < 500; ++n) a->send(makePacket(n), 1.0);
  std::uint64_t expected = 0;
  for (const Arrival& arrival : receiveAll(*b, 2.0, 3.0))
    EXPECT_EQ(arrival.packet.sequence, expected++);
  EXPECT_EQ(expected, 500U);
}

TEST(SimulatedLink, HasNoEcho) {
  const auto [a, b] = makeSimulatedLinks({});
  a->send(makePacket(0), 0.0);
  EXPECT_FALSE(a->receive(1.0, kInfinity).has_value());
  EXPECT_TRUE(b->receive(1.0, kInfinity).has_value());
  EXPECT_EQ(a->counts().sent, 1U);
  EXPECT_EQ(a->counts().delivered, 1U);
  EXPECT_EQ(b->counts().sent, 0U);
  EXPECT_EQ(b->counts().delivered, 0U);
}

TEST(SimulatedLink, OverflowIsDroppedAndCounted) {
  Impairments impairments;
  impairments.delay = 0.5;
  const auto [a, b] = makeSimulatedLinks(impairments, 4);
  for (int round = 0; round < 3; ++round) {
    const double now = round;
    for (std::uint64_t n = 0; n < 6; ++n) a->send(makePacket(n), now);
    const std::vector<Arrival> arrivals = receiveAll(*b, now + 0.1, now + 1.0);
    ASSERT_EQ(arrivals.size(), 4U);
    for (std::uint64_t n = 0; n < 4; ++n) EXPECT_EQ(arrivals[n].packet.sequence, n);
    EXPECT_EQ(a->counts().overflowed, 2U * static_cast<std::uint64_t>(round + 1));
  }
  EXPECT_EQ(a->counts().sent, 18U);
  EXPECT_EQ(a->counts().delivered, 12U);
  EXPECT_EQ(b->counts().overflowed, 0U);
}

TEST(SimulatedLink, DuplicatesNeedRoomOfTheirOwn) {
  Impairments impairments;
  impairments.duplicate = 1.0;
  const auto [a, b] = makeSimulatedLinks(impairments, 3);
  a->send(makePacket(0), 0.0);
  a->send(makePacket(1), 0.0);
  EXPECT_EQ(receiveAll(*b, 1.0, 2.0).size(), 3U);
  EXPECT_EQ(a->counts().duplicated, 2U);
  EXPECT_EQ(a->counts().overflowed, 1U);
}

TEST(SimulatedLink, EitherEndMayOutliveTheOther) {
  auto [a, b] = makeSimulatedLinks({});
  a->send(makePacket(1), 0.0);
  a.reset();
  ASSERT_TRUE(b->receive(1.0, 2.0).has_value());
  b->send(makePacket(2), 1.0);
  EXPECT_EQ(b->counts().sent, 1U);
}

std::string refusal(const Impairments& impairments, std::size_t capacity = 1) {
  try {
    (void)makeSimulatedLinks(impairments, capacity);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SimulatedLink, RefusesBadValuesByName) {
  const auto expectNamed = [](double Impairments::*field, double bad, const std::string& name) {
    Impairments impairments;
    impairments.*field = bad;
    EXPECT_EQ(refusal(impairments).find("network " + name + " = "), 0U) << name << ' ' << bad;
  };
  const double no_number = std::nan("");
  for (const double bad : {-1e-9, kInfinity, -kInfinity, no_number}) {
    expectNamed(&Impairments::delay, bad, "delay");
    expectNamed(&Impairments::jitter, bad, "jitter");
  }
  for (const double bad : {-1e-9, 1.0 + 1e-9, kInfinity, no_number}) {
    expectNamed(&Impairments::loss, bad, "loss");
    expectNamed(&Impairments::duplicate, bad, "duplicate");
    expectNamed(&Impairments::reorder, bad, "reorder");
  }
  EXPECT_NE(refusal({}, 0).find("capacity"), std::string::npos);
  EXPECT_EQ(refusal({1.0, 2.0, 1.0, 1.0, 1.0, 0}), "");
}

}  // namespace
}  // namespace tandem
