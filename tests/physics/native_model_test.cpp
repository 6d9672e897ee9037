// Sites that use Bullet's own contacts and couplers.

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "demos/program/run/virtual_run.h"
#include "demos/program/scenario/scenario.h"
#include "support/checkout.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::FakeDevice;
using test::FakeLink;

constexpr ContactModel kSoftModels[] = {ContactModel::kNativeSoft, ContactModel::kSpring6Dof};

SiteSettings makeNativeSettings(ContactModel model) {
  SiteSettings settings;
  settings.contact_model = model;
  settings.contact = {2000.0, 10.0};      // [N/m, N s/m]
  settings.coordination = {200.0, 10.0};  // [N/m, N s/m]
  settings.guide = Vec3::UnitX();
  return settings;
}

// The proxy's user stays where the proxy starts; the device stands 3 mm deep in it. At rest both
// springs pull alike: the device feels 3 mm K K_t / (K + K_t).
TEST(NativeModel, DeviceFeelsStiffnessTimesPenetrationAtRest) {
  for (const ContactModel model : kSoftModels) {
    BulletRig rig;
    FakeDevice device(Vec3(-0.017, 0, 0));
    FakeLink link;
    Site site(makeNativeSettings(model), rig.world, device);
    site.connect(PeerId{2}, link, Vec3::Zero());
    for (int i = 0; i < 2000; ++i) rig.step(1e-3);
    ASSERT_EQ(site.status(), kTickOk);
    // Only the host's step ticks the site; a float host's millisecond is slightly longer.
    EXPECT_NEAR(static_cast<double>(site.tickCount()), 2000.0, byWidth(0.0, 1.0));
    const double overlap = 0.02 - (site.proxy(0)->p_W.x() - site.hip().p_W.x());
    EXPECT_NEAR(site.force().x(), -2000.0 * overlap, byWidth(1e-6, 1e-2));
    EXPECT_NEAR(site.force().x(), -0.003 * 2000.0 * 200.0 / 2200.0, byWidth(1e-6, 1e-2));
    EXPECT_EQ(site.force().y(), 0.0);
  }
}

TEST(NativeModel, ForceIsHeldBetweenHostSteps) {
  BulletRig rig;
  FakeDevice device(Vec3(-0.017, 0, 0));
  FakeLink link;
  SiteSettings settings = makeNativeSettings(ContactModel::kNativeSoft);
  settings.tick_source = TickSource::kCaller;
  Site site(settings, rig.world, device);
  site.connect(PeerId{2}, link, Vec3::Zero());
  for (int step = 0; step < 20; ++step) {
    site.tick(0.004 * step);
    const Vec3 force_W = site.force();
    for (int tick = 1; tick < 4; ++tick) {
      site.tick(0.004 * step + 0.001 * tick);
      EXPECT_EQ(site.force(), force_W);
    }
    rig.step(0.004);
    if (step > 0) {
      EXPECT_LT(force_W.x(), 0.0);
    }
  }
}

TEST(NativeModel, GivesTheHostEverythingBack) {
  for (const auto model : {ContactModel::kNativeRigid, ContactModel::kNativeSoft,
                           ContactModel::kSpring6Dof, ContactModel::kPointToPoint}) {
    BulletRig rig;
    btRigidBody& cube = rig.addCube(0.2);
    cube.setDamping(btScalar(0.03), btScalar(0.02));
    {
      FakeDevice device(Vec3(-0.04, 0, 0));
      FakeLink link;
      Site site(makeNativeSettings(model), rig.world, device);
      site.connect(PeerId{2}, link, Vec3(0.04, 0, 0));
      site.share(cube, 0.5);
      EXPECT_NEAR(cube.getMass(), 0.1, 1e-7);
      for (int i = 0; i < 10; ++i) rig.step(1.0 / 240.0);
    }
    EXPECT_EQ(cube.getMass(), btScalar(0.2));
    EXPECT_EQ(cube.getLinearDamping(), btScalar(0.03));
    EXPECT_EQ(cube.getLinearFactor(), btVector3(1, 1, 1));
    EXPECT_EQ(cube.getAngularFactor(), btVector3(1, 1, 1));
    EXPECT_EQ(rig.world.getNumCollisionObjects(), 1);
    EXPECT_EQ(rig.world.getNumConstraints(), 0);
  }
}

TEST(NativeModel, TakingTheHandOutOfTheWorldIsNoticed) {
  BulletRig rig;
  FakeDevice device(Vec3(-0.017, 0, 0));
  FakeLink link;
  Site site(makeNativeSettings(ContactModel::kNativeSoft), rig.world, device);
  site.connect(PeerId{2}, link, Vec3::Zero());
  for (int i = 0; i < 50; ++i) rig.step(1e-3);
  ASSERT_LT(site.force().x(), 0.0);
  for (int i = 0; i < rig.world.getNumCollisionObjects(); ++i) {
    btCollisionObject* object = rig.world.getCollisionObjectArray()[i];
    if (object->isKinematicObject()) rig.world.removeRigidBody(btRigidBody::upcast(object));
  }
  for (int i = 0; i < 10; ++i) rig.step(1e-3);
  EXPECT_TRUE(site.status() & kBodyMissing);
  EXPECT_EQ(site.force(), Vec3::Zero());
}

TEST(NativeModel, RefusesWhatHasNoMeaning) {
  BulletRig rig;
  FakeDevice device;
  SiteSettings settings = makeNativeSettings(ContactModel::kNativeSoft);
  settings.injection = Injection::kImpulse;
  EXPECT_THROW(Site(settings, rig.world, device), std::invalid_argument);
  settings = makeNativeSettings(ContactModel::kNativeSoft);
  settings.guide = Vec3(0.6, 0.8, 0);
  EXPECT_THROW(Site(settings, rig.world, device), std::invalid_argument);
  EXPECT_EQ(rig.world.getNumCollisionObjects(), 0);
}

// Whole experiments.

demos::Scenario load(const std::string& file, std::vector<std::string> overrides) {
  return demos::loadScenario(test::inCheckout("demos/scenarios/") + file, overrides);
}

demos::RunSummary run(const std::string& file, std::vector<std::string> overrides) {
  demos::VirtualRun run(load(file, std::move(overrides)));
  run.run();
  return run.summary();
}

class NativeExperiments
    : public ::testing::TestWithParam<std::tuple<const char*, const char*, const char*>> {};

// Rigid contact rings if its own reaction moves the hand. Point2Point's iteration diverges at short
// steps. A run must always end with numbers, or report that there are none.
TEST_P(NativeExperiments, EndFiniteOrSayWhyNot) {
  const auto& [file, model, rate] = GetParam();
  demos::VirtualRun run(
      load(file, {std::string("contact.model=") + model, std::string("rates.host=") + rate,
                  std::string(file) == "playground.toml" ? "experiment.duration=3"
                                                         : "experiment.duration=1"}));
  bool grew = false;
  try {
    run.run();
  } catch (const Error& error) {
    grew = true;
    EXPECT_NE(std::string(error.what()).find("grew beyond all numbers"), std::string::npos);
    EXPECT_TRUE((run.world(0).site().status() | run.world(1).site().status()) & kStateNotFinite);
  }
  // CFM = m / (dt (dt K_t + B_t)) of cube and proxy, both 0.1 kg. It is below 1 in Experiment I at
  // 240 Hz (0.78). It is above 1 in Experiment II and the playground (2.2), and at 1 kHz (3.3,
  // 9.8).
  const bool diverges = std::string(model) == "point_to_point" &&
                        !(std::string(file) == "experiment1.toml" && std::string(rate) == "240");
  EXPECT_EQ(grew, diverges);
  if (grew) return;
  EXPECT_TRUE(std::isfinite(run.summary().coherency_mean));
  EXPECT_GT(run.summary().sites[0].force_max, 1.0);
  EXPECT_GE(run.summary().sites[0].contact_transitions, 1);
}

INSTANTIATE_TEST_SUITE_P(
    All, NativeExperiments,
    ::testing::Combine(::testing::Values("experiment1.toml", "experiment2.toml", "playground.toml"),
                       ::testing::Values("native_rigid", "native_soft", "spring_6dof",
                                         "point_to_point"),
                       ::testing::Values("240", "1000")));

// At the haptic rate Bullet's compliant contact is first order in 1 ms, and so is its use of
// packets. The tolerance is a tenth, as for impulse injection.
TEST(NativeModel, SoftModelsComeNearThePaperAtTheHapticRate) {
  for (const char* model : {"contact.model=native_soft", "contact.model=spring_6dof"}) {
    const auto one = run("experiment1.toml", {model, "rates.host=1000"});
    EXPECT_NEAR(one.coherency_mean, 6.31e-3, 0.1 * 6.31e-3) << model;
    EXPECT_NEAR(one.sites[0].force_mean, 4.921, 0.1 * 4.921) << model;
    EXPECT_EQ(one.sites[0].contact_transitions, 1) << model;
    const auto two = run("experiment2.toml", {model, "rates.host=1000"});
    EXPECT_NEAR(two.sites[0].force_max, 3.52, 0.1 * 3.52) << model;
    EXPECT_NEAR(two.sites[0].device_end, 0.1919, 0.1 * 0.1919) << model;
  }
}

TEST(NativeModel, KnowsTheOtherSchemes) {
  const auto coupled = run("experiment1.toml", {"contact.model=native_soft", "rates.host=1000",
                                                "experiment.scheme=virtual_coupling"});
  EXPECT_NEAR(coupled.coherency_mean, 10.94e-3, 0.1 * 10.94e-3);
  const auto held = run("experiment1.toml", {"contact.model=native_soft", "rates.host=1000",
                                             "experiment.scheme=kinematic_proxy"});
  EXPECT_NEAR(held.coherency_mean, 3.16e-3, 0.1 * 3.16e-3);
}

TEST(NativeModel, RunsAreEqualToTheBit) {
  const auto first = run("experiment1.toml", {"contact.model=spring_6dof"});
  const auto second = run("experiment1.toml", {"contact.model=spring_6dof"});
  EXPECT_EQ(first.state_hash, second.state_hash);
}

}  // namespace
}  // namespace tandem
