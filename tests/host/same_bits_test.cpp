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

// The hand is inside the heap too, and feels no moving body.
TEST_P(SameBits, WithAHandAloneAttached) {
  const Hashes bare = simulateBare();
  for (const Vec3& hand_W : {Vec3(10.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.03)}) {
    Pile pile(GetParam());
    FakeDevice device(hand_W);
    const Site site({}, pile.world(), device);
    EXPECT_EQ(bare, simulate(pile, [&](int i) {
                device.sample.hip.p_W.x() = hand_W.x() + 1e-4 * (i % 50);
              }));
    EXPECT_EQ(site.counters().host_steps, 4u * kSteps);
    EXPECT_EQ(site.neighbourCount(), 0);
  }
}

TEST_P(SameBits, AfterAHandAloneHasLeft) {
  Pile pile(GetParam());
  FakeDevice device(Vec3(0.0, 0.0, 0.03));
  auto site = std::make_unique<Site>(SiteSettings{}, pile.world(), device);
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
