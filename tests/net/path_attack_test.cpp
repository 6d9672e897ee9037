// Datagrams of a peer come from elsewhere: as a NAT changes a port, or as a listener's copies,
// which arrive first. The session follows the former and not the latter.

#include <gtest/gtest.h>

#include "net/attack.h"

namespace tandem {
namespace {

using test::Bytes;
using test::kStranger;
using test::longestGapOver;
using test::VirtualNet;
using test::VirtualSites;

/// Copies what it overhears and sends the copies first, from its own address.
class Copier {
 public:
  explicit Copier(VirtualSites& sites) : copies_(sites.net) {
    sites.net.tap = [this](const Bytes& bytes, const Address& from, const Address& to) {
      if (copies_.isOwn() || !is_on) return;
      if (to.ip == kStranger.ip) {
        ++caught;
        if (is_handing_on) copies_.send(bytes, kStranger, from == a_ ? b_ : a_);
      } else if (is_copying) {
        copies_.send(bytes, kStranger, to);
      }
    };
  }

  bool is_on = true;
  bool is_copying = true;
  bool is_handing_on = false;  ///< what comes to it goes on to the other site
  std::uint64_t caught = 0;    ///< datagrams that were sent to it

 private:
  test::Injector copies_;
  Address a_ = VirtualNet::addressOf(1), b_ = VirtualNet::addressOf(2);
};

// A site took 380 of 1186 states while its peer followed the copies.
TEST(PathAttack, CopiesThatArriveFirstMoveNoAddress) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  Copier copier(sites);
  EXPECT_LT(longestGapOver(sites, 600.0), 0.02);
  for (const int id : {1, 2}) {
    EXPECT_EQ(sites.status(id, 3 - id).address_changes, 0u);
    EXPECT_EQ(sites.status(id, 3 - id).address, VirtualNet::addressOf(3 - id));
  }
  // Two to three challenges a second go there, from each site.
  EXPECT_LT(copier.caught, 600u * 2 * 5);
}

TEST(PathAttack, CopiesFromTheFirstDatagramOnMoveNoAddress) {
  for (const double loss : {0.0, 0.2}) {
    SCOPED_TRACE(loss);
    VirtualSites sites(2, {0.05, 0.02, loss, 0.0, 0.0}, 5);
    Copier copier(sites);
    ASSERT_TRUE(sites.goLive(10.0));
    sites.run(1.0);
    EXPECT_LT(longestGapOver(sites, 200.0), loss > 0.0 ? 0.2 : 0.05);
    EXPECT_EQ(sites.status(1, 2).address, VirtualNet::addressOf(2));
    EXPECT_EQ(sites.status(2, 1).address, VirtualNet::addressOf(1));
  }
}

// A listener that hands on challenges and answers is a way. The old way still answers.
TEST(PathAttack, AWayAroundIsNotTakenWhileTheOldOneAnswers) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  Copier copier(sites);
  copier.is_handing_on = true;
  EXPECT_LT(longestGapOver(sites, 60.0), 0.02);
  EXPECT_EQ(sites.status(1, 2).address_changes, 0u);
  EXPECT_EQ(sites.status(2, 1).address_changes, 0u);
}

// The direct way fails for a while. The sites go around it, by the listener; it then keeps all
// for itself.
TEST(PathAttack, AWayAroundThatFailsIsLeft) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  Copier copier(sites);
  copier.is_handing_on = true;
  const Address away = VirtualNet::addressOf(7);
  const Address own = sites.at(2).port->address;
  sites.at(2).port->address = away;  // its old address leads nowhere
  sites.run(3.0);
  sites.at(2).port->address = own;
  sites.run(3.0);
  copier.is_handing_on = false;
  sites.run(3.0);
  EXPECT_LT(longestGapOver(sites, 10.0), 0.02);
}

TEST(PathAttack, AResponderThatKnowsNoAddressFindsTheTrueOne) {
  VirtualSites sites(2);
  sites.startWithoutAddress(2);
  Copier copier(sites);
  ASSERT_TRUE(sites.goLive(3.0));
  sites.run(3.0);
  EXPECT_EQ(sites.status(2, 1).address, VirtualNet::addressOf(1));
  EXPECT_LT(longestGapOver(sites, 10.0), 0.02);
}

// A NAT changes a port: the new one is found within a round trip and a half, and 50 ms.
TEST(PathAttack, ANewPortIsFoundSoon) {
  for (const int moved : {1, 2}) {
    for (const double delay : {0.002, 0.02, 0.1, 0.3}) {
      SCOPED_TRACE(delay);
      VirtualSites sites(2, {delay, 0.0, 0.0, 0.0, 0.0});
      ASSERT_TRUE(sites.goLive(20 * delay + 1.0));
      sites.run(1.0);
      sites.at(moved).port->address.port = 7999;
      EXPECT_LT(longestGapOver(sites, 5.0), 2 * delay + 3 * delay + 0.05 + 0.03);
      EXPECT_EQ(sites.status(3 - moved, moved).address->port, 7999);
      EXPECT_EQ(sites.status(3 - moved, moved).address_changes, 1u);
    }
  }
}

TEST(PathAttack, ANewPortIsFoundAmongCopies) {
  for (const int moved : {1, 2}) {
    SCOPED_TRACE(moved);
    VirtualSites sites(2);
    ASSERT_TRUE(sites.goLive(1.0));
    Copier copier(sites);
    sites.run(2.0);
    sites.at(moved).port->address.port = 7999;
    EXPECT_LT(longestGapOver(sites, 10.0), 3.0);
    EXPECT_EQ(sites.status(3 - moved, moved).address->port, 7999);
  }
}

// Copies of one state make a site send six challenges to their source, which is less than three
// times the state's bytes.
TEST(PathAttack, AVictimOfCopiesGetsLittle) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  sites.run(1.0);
  std::size_t copied = 0, sent = 0, challenges = 0;
  test::Injector injector(sites.net);
  sites.net.tap = [&](const Bytes& bytes, const Address&, const Address& to) {
    if (to == kStranger) {
      sent += bytes.size();
      ++challenges;
    }
    if (injector.isOwn() || copied > 0 || test::typeOf(bytes) != MessageType::kState) return;
    if (to != VirtualNet::addressOf(1)) return;
    copied = bytes.size();
    injector.send(bytes, kStranger, to);
    sites.net.is_down = true;  // no answer from anywhere ends the check
  };
  sites.run(5.0);
  ASSERT_GT(copied, 0u);
  EXPECT_EQ(challenges, 6u);
  EXPECT_LT(sent, 3 * copied);
}

}  // namespace
}  // namespace tandem
