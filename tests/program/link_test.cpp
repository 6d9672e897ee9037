// `tandem link`: the datagrams that pass, both ways.

#include <algorithm>
#include <csignal>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tandem/coordination/impairments.h"

#include "program/link_rig.h"

namespace tandem::test {
namespace {

/// Sends datagrams `first` to `end` - 1 from one endpoint towards the other. They are about a
/// millisecond apart, so that no system buffer overflows. Adds arrivals to `arrived`. Returns the
/// send times [s].
std::vector<double> sendNumbers(std::uint64_t first, std::uint64_t end, Endpoint& from,
                                const Address& to, Endpoint& receiver,
                                std::vector<Endpoint::Arrived>& arrived) {
  std::vector<double> sent;
  for (std::uint64_t n = first; n < end; ++n) {
    sent.push_back(readMonotonicClock());
    from.send(makeDatagram(n), to);
    while (const auto one = receiver.receive(1e-3)) arrived.push_back(*one);
  }
  return sent;
}

/// The copies that come out for datagrams 0 to `count` - 1 by their fates, sorted.
std::vector<Bytes> expectedCopies(const Impairments& impairments, double corrupt,
                                  Direction direction, std::uint64_t count) {
  std::vector<Bytes> copies;
  for (std::uint64_t n = 0; n < count; ++n) {
    const PacketFate fate = computeFate(impairments, direction, n);
    if (fate.is_lost) continue;
    for (const Copy copy : {Copy::kFirst, Copy::kDuplicate}) {
      if (copy == Copy::kDuplicate && !fate.is_duplicated) continue;
      Bytes bytes = makeDatagram(n);
      if (const auto bit =
              computeCorruptBit(corrupt, impairments.seed, direction, n, copy, bytes.size()))
        bytes[*bit / 8] = static_cast<std::uint8_t>(bytes[*bit / 8] ^ (1U << (*bit % 8)));
      copies.push_back(bytes);
    }
  }
  std::sort(copies.begin(), copies.end());
  return copies;
}

std::vector<Bytes> sortedBytes(const std::vector<Endpoint::Arrived>& arrived) {
  std::vector<Bytes> bytes;
  for (const auto& one : arrived) bytes.push_back(one.bytes);
  std::sort(bytes.begin(), bytes.end());
  return bytes;
}

void receiveUpTo(std::size_t count, Endpoint& receiver, std::vector<Endpoint::Arrived>& arrived) {
  while (arrived.size() < count) {
    const auto one = receiver.receive(kPatience);
    ASSERT_TRUE(one) << arrived.size() << " of " << count << " came";
    arrived.push_back(*one);
  }
}

nlohmann::json finishWithReport(LinkRig& rig) {
  const Outcome outcome = rig.link.finish(SIGINT);
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  return nlohmann::json::parse(outcome.out);
}

TEST(Link, GivesEachDatagramItsFateInBothDirections) {
  constexpr std::uint64_t kCount = 400;
  const Impairments impairments{0.02, 0.005, 0.1, 0.1, 0.05, 7};
  LinkRig rig({"--delay", "20ms", "--jitter", "5ms", "--loss", "10%", "--duplicate", "0.1",
               "--reorder", "5%", "--corrupt", "20%", "--seed", "7", "--json"});
  std::vector<Endpoint::Arrived> there, back;
  (void)sendNumbers(0, kCount, rig.client, rig.proxy, rig.server, there);
  const auto expected_there = expectedCopies(impairments, 0.2, Direction::kForward, kCount);
  receiveUpTo(expected_there.size(), rig.server, there);
  ASSERT_EQ(sortedBytes(there), expected_there);

  (void)sendNumbers(0, kCount, rig.server, there.front().from, rig.client, back);
  const auto expected_back = expectedCopies(impairments, 0.2, Direction::kBack, kCount);
  receiveUpTo(expected_back.size(), rig.client, back);
  ASSERT_EQ(sortedBytes(back), expected_back);
  for (const auto& one : back) EXPECT_EQ(one.from, rig.proxy);

  const nlohmann::json report = finishWithReport(rig);
  for (const auto& [lane, copies] :
       {std::pair{"forward", expected_there.size()}, {"back", expected_back.size()}}) {
    const nlohmann::json& one = report[lane];
    EXPECT_EQ(one["datagrams"], kCount);
    EXPECT_EQ(one["counts"]["delivered"], copies);
    EXPECT_EQ(one["counts"]["under_way"], 0);
    EXPECT_EQ(one["counts"]["overflowed"], 0);
    EXPECT_NEAR(one["asked"]["loss"].get<double>(), 0.1, 1e-9);
    EXPECT_NEAR(one["asked"]["jitter"].get<double>(), 0.005, 1e-9);
    EXPECT_EQ(one["achieved"]["loss"],
              one["counts"]["lost"].get<double>() / static_cast<double>(kCount));
    EXPECT_GE(one["self_latency"]["p99"], one["self_latency"]["median"]);
  }
}

TEST(Link, DelaysEachDatagramByNoLessThanAskedAndKeepsOrder) {
  constexpr std::uint64_t kCount = 200;
  LinkRig rig({"--delay", "0.03s", "--jitter", "10ms", "--keep-order", "--json"});
  std::vector<Endpoint::Arrived> arrived;
  const std::vector<double> sent =
      sendNumbers(0, kCount, rig.client, rig.proxy, rig.server, arrived);
  receiveUpTo(kCount, rig.server, arrived);
  for (std::uint64_t n = 0; n < kCount; ++n) {
    ASSERT_EQ(arrived[n].bytes, makeDatagram(n));
    ASSERT_GE(arrived[n].at - sent[n],
              computeFate({0.03, 0.01}, Direction::kForward, n).delay - 1e-6);
  }
  const nlohmann::json report = finishWithReport(rig);
  EXPECT_GE(report["forward"]["achieved"]["delay_p99"], 0.03);
  EXPECT_EQ(report["forward"]["counts"]["overtaken"], 0);
  EXPECT_TRUE(report["back"]["achieved"]["delay"].is_null());
}

TEST(Link, WithoutImpairmentsPassesEverythingOnAsItIs) {
  LinkRig rig;
  const Bytes longest(1472, 0x5a), empty;
  rig.client.send(longest, rig.proxy);
  const auto first = rig.server.receive(kPatience);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->bytes, longest);
  rig.client.send(empty, rig.proxy);
  const auto second = rig.server.receive(kPatience);
  ASSERT_TRUE(second);
  EXPECT_TRUE(second->bytes.empty());
  rig.server.send(longest, first->from);
  const auto answer = rig.client.receive(kPatience);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->bytes, longest);
}

TEST(Link, AnswersGoToWhereTheClientSentFromLast) {
  LinkRig rig;
  Endpoint moved;
  rig.client.send(makeDatagram(0), rig.proxy);
  ASSERT_TRUE(rig.server.receive(kPatience));
  moved.send(makeDatagram(1), rig.proxy);
  const auto seen = rig.server.receive(kPatience);
  ASSERT_TRUE(seen);
  rig.server.send(makeDatagram(2), seen->from);
  const auto answer = moved.receive(kPatience);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->bytes, makeDatagram(2));
}

TEST(Link, LetsNobodyInButTheServer) {
  LinkRig rig({"--json"});
  Endpoint stranger;
  rig.client.send(makeDatagram(0), rig.proxy);
  const auto seen = rig.server.receive(kPatience);
  ASSERT_TRUE(seen);
  stranger.send(makeDatagram(1), seen->from);
  rig.server.send(makeDatagram(2), seen->from);  // after the stranger's in the same queue
  const auto answer = rig.client.receive(kPatience);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->bytes, makeDatagram(2));
  EXPECT_EQ(finishWithReport(rig)["strangers"], 1);
}

TEST(Link, CountsWhatIsTooLong) {
  LinkRig rig({"--json"});
  rig.client.send(Bytes(1600), rig.proxy);
  rig.client.send(makeDatagram(1), rig.proxy);
  const auto seen = rig.server.receive(kPatience);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->bytes, makeDatagram(1));
  EXPECT_EQ(finishWithReport(rig)["forward"]["counts"]["too_long"], 1);
}

/// Sends until the server receives one that `is_wanted` accepts; false if it never does.
template <typename IsWanted>
bool sendUntil(LinkRig& rig, const IsWanted& is_wanted) {
  const double until = readMonotonicClock() + kPatience;
  for (std::uint64_t n = 0; readMonotonicClock() < until; ++n) {
    rig.client.send(makeDatagram(n), rig.proxy);
    while (const auto seen = rig.server.receive(5e-3))
      if (is_wanted(*seen)) return true;
  }
  return false;
}

TEST(LinkScript, RebindsToAnotherPort) {
  const TempFolder folder;
  std::string script;  // several times, in case the first datagram is slow
  for (const char* at : {"0.2", "1", "5", "20"})
    script += std::string("[[change]]\nat = ") + at + "\nrebind = true\n";
  LinkRig rig({"--script", folder.write("s.toml", script)});
  std::optional<Address> first;
  ASSERT_TRUE(sendUntil(rig, [&](const Endpoint::Arrived& seen) {
    if (!first) first = seen.from;
    return seen.from != *first;
  }));
  rig.server.send(makeDatagram(9), *first);  // the old port is closed
  ASSERT_TRUE(sendUntil(rig, [&](const Endpoint::Arrived& seen) {
    rig.server.send(makeDatagram(7), seen.from);
    return seen.from != *first;
  }));
  const auto answer = rig.client.receive(kPatience);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->bytes, makeDatagram(7));
}

TEST(LinkScript, AnOutageEnds) {
  const TempFolder folder;
  LinkRig rig({"--json", "--script",
               folder.write("s.toml",
                            "[[change]]\nat = 0\noutage = true\n"
                            "[[change]]\nat = 1\noutage = false\n")});
  ASSERT_TRUE(sendUntil(rig, [](const Endpoint::Arrived&) { return true; }));
  const nlohmann::json counts = finishWithReport(rig)["forward"]["counts"];
  EXPECT_GE(counts["cut_off"], 1);
  EXPECT_GE(counts["delivered"], 1);
  EXPECT_EQ(counts["lost"], 0);
}

TEST(LinkScript, CutsOneWayAlone) {
  const TempFolder folder;
  LinkRig rig(
      {"--json", "--script", folder.write("s.toml", "[[change]]\nat = 0\ncut = \"back\"\n")});
  rig.client.send(makeDatagram(0), rig.proxy);
  const auto seen = rig.server.receive(kPatience);
  ASSERT_TRUE(seen);
  for (std::uint64_t n = 1; n <= 5; ++n) {
    rig.server.send(makeDatagram(n), seen->from);
    rig.client.send(makeDatagram(n), rig.proxy);
    ASSERT_TRUE(rig.server.receive(kPatience));
  }
  const nlohmann::json report = finishWithReport(rig);
  EXPECT_GE(report["back"]["counts"]["cut_off"], 4);  // the last may not have come in yet
  EXPECT_EQ(report["back"]["counts"]["delivered"], 0);
  EXPECT_EQ(report["forward"]["counts"]["delivered"], 6);
  EXPECT_FALSE(rig.client.receive(0.0));
}

TEST(LinkScript, StepsTheDelay) {
  const TempFolder folder;
  LinkRig rig({"--script", folder.write("s.toml", "[[change]]\nat = 0\ndelay = \"60ms\"\n")});
  const double sent = readMonotonicClock();
  rig.client.send(makeDatagram(0), rig.proxy);
  const auto seen = rig.server.receive(kPatience);
  ASSERT_TRUE(seen);
  EXPECT_GE(seen->at - sent, 0.06 - 1e-6);
}

}  // namespace
}  // namespace tandem::test
