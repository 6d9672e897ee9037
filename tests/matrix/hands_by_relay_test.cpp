// What hands feel of a relay: changes of the way, and a relay that lies.

#include "matrix/hands_by_relay.h"

#include <deque>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

namespace tandem {
namespace {

using test::Bytes;
using test::ForceReport;
using test::HandsByRelay;
using test::Random;
using test::VirtualNet;

/// Runs until hands, copies and playout have settled.
void settle(HandsByRelay& hands) {
  hands.sites.run(15.0);
  ASSERT_EQ(hands.link(1), LinkState::kLive);
  ASSERT_EQ(hands.link(2), LinkState::kLive);
  (void)hands.take();
}

// The relayed way is 6 ms longer. TANDEM_WAY_SECONDS=3600 runs an hour.
TEST(HandsByRelay, ChangesOfTheWayOnceASecondAreNotFelt) {
  HandsByRelay hands({.to_relay = 0.008});
  hands.sites.by_relay = false;
  settle(hands);
  hands.sites.run(20.0);
  const ForceReport quiet = hands.take();
  const auto changes = static_cast<int>(test::readCount("TANDEM_WAY_SECONDS", 100));
  for (int i = 0; i < changes; ++i) {
    hands.sites.by_relay = i % 2 == 0;
    hands.sites.run(1.0);
  }
  const ForceReport changing = hands.take();
  RecordProperty("quiet_rise_uN", static_cast<int>(1e6 * quiet.rise));
  RecordProperty("changing_rise_uN", static_cast<int>(1e6 * changing.rise));
  EXPECT_LT(changing.rise, 2.0 * quiet.rise) << quiet.rise << " N from tick to tick without";
  EXPECT_LT(changing.force, 1.25 * quiet.force);
  EXPECT_EQ(hands.sites.status(1, 2).states_too_late, 0u);
}

/// A relay that drops, repeats, delays, turns bits and sends to the wrong one, at will.
class Liar {
 public:
  explicit Liar(std::uint64_t seed) : random_(seed) {}
  void operator()(Bytes& bytes, Address& to) {
    kept_.push_back({bytes, to});
    if (kept_.size() > 64) kept_.pop_front();
    const int wish = random_.below(8);
    if (wish < 2) {  // of late, or twice
      const auto at = static_cast<std::size_t>(random_.below(static_cast<int>(kept_.size())));
      std::tie(bytes, to) = kept_[at];
    } else if (wish == 2) {
      bytes[static_cast<std::size_t>(random_.below(static_cast<int>(bytes.size())))] ^= 1;
    } else if (wish == 3) {
      to = VirtualNet::addressOf(1 + random_.below(3));
    } else if (wish == 4) {
      bytes.resize(static_cast<std::size_t>(random_.below(static_cast<int>(bytes.size()) + 1)));
    }
  }

 private:
  Random random_;
  std::deque<std::pair<Bytes, Address>> kept_;
};

// Hands feel no more than at a wall, which gives the arm's 9 N, and all is as before when it ends.
TEST(HandsByRelay, ARelayThatLiesGivesNoMoreThanAWall) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(seed);
    HandsByRelay hands({.has_direct = false});
    settle(hands);
    const double apart = hands.apart();
    hands.sites.relay_port.lie = Liar(seed);
    hands.sites.run(20.0);
    const ForceReport lied = hands.take();
    EXPECT_TRUE(lied.is_finite);
    EXPECT_LT(lied.force, HandsByRelay::kWallForce);
    EXPECT_LT(lied.rise, 1.0);
    EXPECT_GT(hands.putIn(), 0.0);
    hands.sites.relay_port.lie = nullptr;
    hands.sites.run(20.0);
    EXPECT_EQ(hands.link(1), LinkState::kLive);
    EXPECT_EQ(hands.link(2), LinkState::kLive);
    EXPECT_NEAR(hands.apart(), apart, 0.2 * apart);
  }
}

}  // namespace
}  // namespace tandem
