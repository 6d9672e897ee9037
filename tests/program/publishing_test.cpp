// The thread that shows a site: nobody waits for it, and it shows the newest.

#include "peer/publishing.h"

#include <future>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"

#include "bridge/bullet_rig.h"

namespace tandem::demos {
namespace {

constexpr double kHostStep = 1.0 / 240.0;  // [s]

/// A user alone with a shared cube.
struct Alone {
  Alone() { site.share(rig.addCube(0.2)); }
  static SiteSettings settings() {
    SiteSettings settings;
    settings.self = PeerId{4};
    return settings;
  }
  void step(SitePublisher& publisher) {
    rig.step(kHostStep);
    publisher.noteStep(++steps * kHostStep, site);
  }

  test::BulletRig rig;
  SimulatedDevice device{{}, makeConstantHand({1.0, 0.0, 0.0})};
  Site site{settings(), rig.world, device};
  int steps = 0;
};

TEST(SitePublisher, ABusThatHangsHoldsUpNobody) {
  Alone user;
  std::promise<void> bus;
  std::vector<SiteStates> shown;
  {
    SitePublisher publisher(
        [&, goes_on = bus.get_future().share()](const SiteStates& states) {
          goes_on.wait();
          shown.push_back(states);
        },
        PeerId{4});
    for (int i = 0; i < 41; ++i) user.step(publisher);
    bus.set_value();
  }
  ASSERT_FALSE(shown.empty());
  EXPECT_LE(shown.size(), 2u) << "the one that hung, and the newest";
  EXPECT_EQ(shown.back().tick, user.site.tickCount());
  EXPECT_EQ(shown.back().site, PeerId{4});
  EXPECT_EQ(shown.back().hand.p_W, user.site.hip().p_W);
  EXPECT_EQ(shown.back().force_W, user.site.force());
  ASSERT_EQ(shown.back().objects.size(), 1u);
  EXPECT_EQ(shown.back().objects[0].state.p_W, user.site.object(0).p_W);
}

TEST(SitePublisher, PicturesAreASixtiethOfASecondApart) {
  Alone user;
  std::vector<double> times;
  {
    SitePublisher publisher([&](const SiteStates& states) { times.push_back(states.time); },
                            PeerId{4});
    for (int i = 0; i < 240; ++i) user.step(publisher);
  }
  ASSERT_FALSE(times.empty());
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i] - times[i - 1], 0.0166);
}

// After a change of scheme the time begins at 0 again.
TEST(SitePublisher, TheNextRunIsShownFromItsBeginning) {
  Alone user;
  std::vector<double> times;
  {
    SitePublisher publisher([&](const SiteStates& states) { times.push_back(states.time); },
                            PeerId{4});
    for (int i = 0; i < 240; ++i) user.step(publisher);
    user.steps = 0;
    user.step(publisher);
  }
  ASSERT_FALSE(times.empty());
  EXPECT_EQ(times.back(), kHostStep);
}

}  // namespace
}  // namespace tandem::demos
