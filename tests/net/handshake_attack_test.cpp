// A listener on the way who does not have the key answers, copies and replays what belongs to the
// handshake. A session begins and renews its keys within the time that it takes without.

#include <gtest/gtest.h>

#include "net/attack.h"

namespace tandem {
namespace {

using net::Refusal;
using test::Bytes;
using test::kStranger;
using test::typeOf;
using test::VirtualNet;
using test::VirtualSites;

/// Overhears a network and sends datagrams of its own, from any address.
class Listener : public test::Injector {
 public:
  explicit Listener(VirtualNet& net, std::uint64_t seed = 20090405)
      : Injector(net), random_(seed) {}

  /// A COOKIE as an answer to this HELLO, with random bytes where only the responder knows better.
  Bytes forgeCookie(const Bytes& hello) {
    const auto asked = decodeHello({hello.data(), hello.size()});
    CookieMessage forged;
    forged.route = {asked->route.receiver, asked->route.sender, asked->route.nonce};
    Bytes bytes(kCookieSize);
    (void)encodeCookie(forged, {bytes.data(), bytes.size()});
    for (std::size_t k = 32; k < bytes.size(); ++k)
      bytes[k] = static_cast<std::uint8_t>(random_.below(256));
    return bytes;
  }

 private:
  test::Random random_;
};

/// Runs for this long and expects that states went both ways without a gap.
void expectNoGap(VirtualSites& sites, double seconds) {
  EXPECT_LT(test::longestGapOver(sites, seconds), 0.02);
}

// A forged COOKIE before each true one ended a session at the age of its keys, 180 s.
TEST(HandshakeAttack, AForgedCookieForEachHelloChangesNothing) {
  VirtualSites sites(2);
  Listener listener(sites.net);
  int forged = 0;
  sites.net.tap = [&](const Bytes& bytes, const Address& from, const Address& to) {
    if (listener.isOwn() || typeOf(bytes) != MessageType::kHello) return;
    ++forged;
    listener.send(listener.forgeCookie(bytes), to, from);
  };
  ASSERT_TRUE(sites.goLive(1.0));
  EXPECT_LT(sites.clock(), 4 * 2 * sites.net.conditions.delay + 0.01);
  expectNoGap(sites, 600.0);
  EXPECT_GE(forged, 5);
  EXPECT_GT(sites.at(1).mesh->counts().of(Refusal::kForged), 0u);
}

// A thousand of them for each HELLO: memory does not grow, and the true one counts.
TEST(HandshakeAttack, AFloodOfForgedCookiesChangesNothing) {
  VirtualSites sites(2);
  Listener listener(sites.net);
  sites.net.tap = [&](const Bytes& bytes, const Address& from, const Address& to) {
    if (listener.isOwn() || typeOf(bytes) != MessageType::kHello) return;
    for (int i = 0; i < 1000; ++i) listener.send(listener.forgeCookie(bytes), to, from);
  };
  ASSERT_TRUE(sites.goLive(1.0));
  EXPECT_LT(sites.clock(), 4 * 2 * sites.net.conditions.delay + 0.01);
  expectNoGap(sites, 300.0);
}

// The listener asks for itself: it copies each HELLO from other addresses, and hands on what
// the responder answers there before the true answer comes.
TEST(HandshakeAttack, CookiesForCopiesOfAHelloChangeNothing) {
  VirtualSites sites(2);
  Listener listener(sites.net);
  sites.net.tap = [&](const Bytes& bytes, const Address&, const Address& to) {
    if (listener.isOwn()) return;
    if (typeOf(bytes) == MessageType::kHello)
      for (std::uint16_t port = 1; port <= 5; ++port) {
        Address other = kStranger;
        other.port = port;
        listener.send(bytes, other, to);
      }
    if (typeOf(bytes) == MessageType::kCookie && to.ip == kStranger.ip)
      listener.send(bytes, VirtualNet::addressOf(2), VirtualNet::addressOf(1));
  };
  ASSERT_TRUE(sites.goLive(1.0));
  EXPECT_LT(sites.clock(), 4 * 2 * sites.net.conditions.delay + 0.01);
  expectNoGap(sites, 300.0);
}

// An OPEN of an earlier session, with a cookie that was asked for anew: the keys that the responder
// has just made for the true one stay.
TEST(HandshakeAttack, AnOpenOfAnEarlierSessionDoesNotDisplaceNewKeys) {
  VirtualSites sites(2);
  Bytes old_hello, old_open;
  sites.net.tap = [&](const Bytes& bytes, const Address&, const Address&) {
    if (typeOf(bytes) == MessageType::kHello) old_hello = bytes;
    if (typeOf(bytes) == MessageType::kOpen) old_open = bytes;
  };
  ASSERT_TRUE(sites.goLive(1.0));
  // Both programs begin anew. The listener asks for a cookie before they do.
  sites.net.tap = nullptr;
  sites.stop(1);
  sites.start(2);
  Bytes cookie;
  sites.net.tap = [&](const Bytes& bytes, const Address&, const Address& to) {
    if (typeOf(bytes) == MessageType::kCookie && to == kStranger) cookie = bytes;
  };
  sites.net.carry(old_hello, kStranger, VirtualNet::addressOf(2));
  sites.run(0.1);
  ASSERT_FALSE(cookie.empty());
  Listener listener(sites.net);
  std::copy_n(cookie.begin() + 32, 16, old_open.begin() + 32);
  sites.net.tap = [&](const Bytes& bytes, const Address&, const Address& to) {
    if (listener.isOwn() || typeOf(bytes) != MessageType::kAccept) return;
    if (to == VirtualNet::addressOf(1))
      listener.send(old_open, kStranger, VirtualNet::addressOf(2));
  };
  sites.start(1);
  ASSERT_TRUE(sites.goLive(1.0));
  EXPECT_GT(sites.at(2).mesh->counts().of(Refusal::kKey), 0u);
  expectNoGap(sites, 10.0);
}

// Forged HELLOs in the peer's name use up nobody's share of answers.
TEST(HandshakeAttack, FloodOfForgedHellosDelaysNobody) {
  VirtualSites sites(2);
  sites.stop(1);
  Listener listener(sites.net);
  sites.run(0.01);
  sites.start(1);
  std::uint64_t nonce = 0;
  for (int tick = 0; tick < 160; ++tick) {
    for (int i = 0; i < 20; ++i) {
      Bytes hello(kHelloSize);
      (void)encodeHello({{PeerId{1}, PeerId{2}, ++nonce}, {}}, {hello.data(), hello.size()});
      listener.send(hello, VirtualNet::addressOf(1), VirtualNet::addressOf(2));
    }
    sites.step();
    if (sites.areLive()) break;
  }
  EXPECT_TRUE(sites.areLive());
}

// Recorded HELLOs are as authentic as new ones. Twenty in the peer's name before each used up the
// answers of that moment, and the session ended at the age of its keys.
TEST(HandshakeAttack, RecordedHellosDoNotDelayNewKeys) {
  VirtualSites sites(2);
  Listener listener(sites.net);
  std::vector<Bytes> recorded;
  sites.net.tap = [&](const Bytes& bytes, const Address& from, const Address& to) {
    if (listener.isOwn() || typeOf(bytes) != MessageType::kHello) return;
    for (int i = 0; i < 20 && !recorded.empty(); ++i)
      listener.send(recorded[static_cast<std::size_t>(i) % recorded.size()], from, to);
    if (sites.clock() < 1.0) recorded.push_back(bytes);
  };
  // Some are of earlier programs at both sites.
  for (int i = 0; i < 3; ++i) {
    sites.start(1);
    sites.start(2);
    const double begun = sites.clock();
    ASSERT_TRUE(sites.goLive(1.0));
    EXPECT_LT(sites.clock() - begun, 4 * 2 * sites.net.conditions.delay + 0.01);
  }
  EXPECT_GE(recorded.size(), 3u);
  expectNoGap(sites, 400.0);
}

// A clock that was set back makes HELLOs look recorded. They are answered all the same.
TEST(HandshakeAttack, ASiteWhoseClockWasSetBackJoins) {
  for (const int restarted : {1, 2}) {
    SCOPED_TRACE(restarted);
    VirtualSites sites(2);
    sites.clock_ahead = 1e6;
    sites.start(1);
    sites.start(2);
    ASSERT_TRUE(sites.goLive(1.0));
    sites.clock_ahead = 0.0;
    sites.stop(restarted);
    sites.run(2.0);
    sites.start(restarted);
    EXPECT_TRUE(sites.goLive(3.0));
    expectNoGap(sites, 300.0);
  }
}

// A listener has the cookie as soon as it is sent. OPENs of its own with it used up the answers of
// that moment.
TEST(HandshakeAttack, ForgedOpensWithTheRightCookieDelayNobody) {
  VirtualSites sites(2);
  Listener listener(sites.net);
  sites.net.tap = [&](const Bytes& bytes, const Address& from, const Address& to) {
    if (listener.isOwn() || typeOf(bytes) != MessageType::kOpen) return;
    for (std::uint8_t i = 1; i <= 20; ++i) {
      Bytes forged = bytes;
      forged[60] ^= i;
      listener.send(forged, from, to);
    }
  };
  ASSERT_TRUE(sites.goLive(1.0));
  EXPECT_LT(sites.clock(), 4 * 2 * sites.net.conditions.delay + 0.01);
  expectNoGap(sites, 400.0);
}

// A forged REFUSE that speaks of a wrong cookie, after each OPEN.
TEST(HandshakeAttack, ForgedRefusalsChangeNothing) {
  VirtualSites sites(2);
  Listener listener(sites.net);
  sites.net.tap = [&](const Bytes& bytes, const Address& from, const Address& to) {
    if (listener.isOwn() || typeOf(bytes) != MessageType::kOpen) return;
    const auto open = decodeOpen({bytes.data(), bytes.size()});
    RefuseMessage refuse;
    refuse.route = {open->route.receiver, open->route.sender, open->route.nonce};
    refuse.code = RefuseCode::kCookie;
    Bytes forged(kRefuseSize);
    (void)encodeRefuse(refuse, {forged.data(), forged.size()});
    for (int i = 0; i < 10; ++i) listener.send(forged, to, from);
  };
  ASSERT_TRUE(sites.goLive(1.0));
  EXPECT_LT(sites.clock(), 4 * 2 * sites.net.conditions.delay + 0.01);
  expectNoGap(sites, 300.0);
}

}  // namespace
}  // namespace tandem
