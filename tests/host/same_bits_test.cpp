// Attaching a site that shares nothing does not change a bit of the host's simulation, nor does
// detaching.

#include <memory>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "host/pile.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::FakeDevice;
using test::FakeLink;
using test::Pile;
using test::WorldKind;

constexpr int kSteps = 300;
constexpr int kMiddle = 150;

using Hashes = std::vector<std::uint64_t>;

/// Hashes after each step; calls `before` ahead of each step.
template <typename Before>
Hashes simulate(Pile& pile, Before before) {
  Hashes hashes;
  for (int i = 0; i < kSteps; ++i) {
    before(i);
    pile.step();
    hashes.push_back(pile.hash());
  }
  return hashes;
}

class SameBits : public ::testing::TestWithParam<WorldKind> {
 protected:
  [[nodiscard]] Hashes simulateBare() const {
    Pile pile(GetParam());
    return simulate(pile, [](int) {});
  }
};

TEST_P(SameBits, TheSceneIsOneThatWouldShowADifference) {
  Pile pile(GetParam()), nudged(GetParam());
  const Hashes hashes = simulate(pile, [](int) {});
  EXPECT_NE(hashes, simulate(nudged, [&](int i) {
              if (i == 20) nudged.body(2).applyCentralImpulse(btVector3(btScalar(1e-6), 0, 0));
            }));
  for (int i = 1; i < kMiddle; ++i) ASSERT_NE(hashes[i], hashes[i - 1]) << "nothing moves";
}

/// A hand that touches no moving body.
SiteSettings makeFixedOnly() {
  SiteSettings settings;
  settings.hand_feels_moving_bodies = false;
  return settings;
}

// A hand far away feels nothing. One inside the heap feels no moving body if told so.
TEST_P(SameBits, WithAHandAloneAttached) {
  const Hashes bare = simulateBare();
  for (const bool is_near : {false, true}) {
    const Vec3 hand_W = is_near ? Vec3(0.0, 0.0, 0.03) : Vec3(10.0, 0.0, 0.0);
    Pile pile(GetParam());
    FakeDevice device(hand_W);
    const Site site(is_near ? makeFixedOnly() : SiteSettings{}, pile.world(), device);
    EXPECT_EQ(bare, simulate(pile, [&](int i) {
                device.sample.hip.p_W.x() = hand_W.x() + 1e-4 * (i % 50);
              }));
    EXPECT_EQ(site.counters().host_steps, 4u * kSteps);
    EXPECT_EQ(site.neighbourCount(), 0);
  }
}

// In the heap the default hand does change it, so the test above would show that.
TEST_P(SameBits, NotWithAHandAloneInTheHeap) {
  Pile pile(GetParam());
  FakeDevice device(Vec3(0.0, 0.0, 0.03));
  const Site site({}, pile.world(), device);
  EXPECT_NE(simulateBare(), simulate(pile, [](int) {}));
  EXPECT_GT(site.counters().promoted, 0u);
}

// Until its caller ticks, a hand is nowhere.
TEST_P(SameBits, WhileNobodyTicks) {
  Pile pile(GetParam());
  FakeDevice device(Vec3(0.0, 0.0, 0.03));
  SiteSettings settings;
  settings.tick_source = TickSource::kCaller;
  const Site site(settings, pile.world(), device);
  EXPECT_EQ(simulateBare(), simulate(pile, [](int) {}));
  EXPECT_EQ(site.counters().promoted, 0u);
}

TEST_P(SameBits, AfterAHandAloneHasLeft) {
  Pile pile(GetParam());
  FakeDevice device(Vec3(0.0, 0.0, 0.03));
  auto site = std::make_unique<Site>(makeFixedOnly(), pile.world(), device);
  EXPECT_EQ(simulateBare(), simulate(pile, [&](int i) {
              if (i == kMiddle) site.reset();
            }));
}

TEST_P(SameBits, AfterSharingAndLeavingBeforeTheFirstStep) {
  Pile pile(GetParam());
  FakeDevice device(Vec3(0.0, 0.0, 0.03));
  FakeLink link;
  {
    Site site({}, pile.world(), device);
    site.share(pile.body(0));
    site.connect(PeerId{2}, link, Vec3(0.0, 0.05, 0.05));
    ASSERT_GT(site.neighbourCount(), 0);
  }
  EXPECT_EQ(simulateBare(), simulate(pile, [](int) {}));
}

INSTANTIATE_TEST_SUITE_P(Kinds, SameBits, ::testing::ValuesIn(test::kAllKinds),
                         [](const auto& kind) { return test::nameOf(kind.param); });

}  // namespace
}  // namespace tandem
