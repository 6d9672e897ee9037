#include "bullet_bridge/src/world/host_world.h"

#include <cmath>
#include <new>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"

namespace tandem {
namespace {

using test::BulletRig;

/// Order in which callbacks ran; one trace per test.
std::string trace;

struct TracingListener final : HostStepListener {
  void beforeHostStep(double dt) noexcept override {
    trace += "b";
    steps.push_back(dt);
  }
  void afterHostStep(double) noexcept override { trace += "a"; }
  std::vector<double> steps;
};

int host_user_data = 0;

void hostPreTick(btDynamicsWorld* world, btScalar) {
  trace += world->getWorldUserInfo() == &host_user_data ? "H" : "!";
}
void hostPostTick(btDynamicsWorld* world, btScalar) {
  trace += world->getWorldUserInfo() == &host_user_data ? "h" : "!";
}

struct Slots : btDynamicsWorld {
  static btInternalTickCallback pre(btDynamicsWorld& world) {
    return world.*(&Slots::m_internalPreTickCallback);
  }
  static btInternalTickCallback post(btDynamicsWorld& world) {
    return world.*(&Slots::m_internalTickCallback);
  }
};

/// Another plugin that chains as we do, and may leave in any order.
struct Layer {
  explicit Layer(btDynamicsWorld& host) : world(host) {
    below_pre = Slots::pre(world);
    below_post = Slots::post(world);
    world.setInternalTickCallback(&Layer::preTick, world.getWorldUserInfo(), true);
    world.setInternalTickCallback(&Layer::postTick, world.getWorldUserInfo(), false);
  }
  ~Layer() {
    world.setInternalTickCallback(below_pre, world.getWorldUserInfo(), true);
    world.setInternalTickCallback(below_post, world.getWorldUserInfo(), false);
  }
  static void preTick(btDynamicsWorld* world, btScalar dt) {
    if (below_pre) below_pre(world, dt);
    trace += "L";
  }
  static void postTick(btDynamicsWorld* world, btScalar dt) {
    trace += "l";
    if (below_post) below_post(world, dt);
  }
  btDynamicsWorld& world;
  static btInternalTickCallback below_pre, below_post;
};
btInternalTickCallback Layer::below_pre = nullptr;
btInternalTickCallback Layer::below_post = nullptr;

std::string traceOfStep(BulletRig& rig) {
  trace.clear();
  rig.step(1e-3);
  return trace;
}

struct HostWorldTest : ::testing::Test {
  HostWorldTest() {
    rig.world.setInternalTickCallback(hostPreTick, &host_user_data, true);
    rig.world.setInternalTickCallback(hostPostTick, &host_user_data, false);
  }
  BulletRig rig;
  TracingListener listener;
};

TEST_F(HostWorldTest, CallsHostFirstBeforeAndLastAfterWithItsOwnPointer) {
  const HostWorld attached(rig.world, listener);
  EXPECT_EQ(traceOfStep(rig), "Hbah");
  EXPECT_EQ(rig.world.getWorldUserInfo(), &host_user_data);
}

TEST_F(HostWorldTest, PutsHostCallbacksBackOnDetach) {
  { const HostWorld attached(rig.world, listener); }
  EXPECT_EQ(Slots::pre(rig.world), &hostPreTick);
  EXPECT_EQ(Slots::post(rig.world), &hostPostTick);
  EXPECT_EQ(rig.world.getWorldUserInfo(), &host_user_data);
  EXPECT_EQ(traceOfStep(rig), "Hh");
}

TEST_F(HostWorldTest, KeepsAPointerThatTheHostSetsWhileAttached) {
  rig.world.setWorldUserInfo(nullptr);
  {
    const HostWorld attached(rig.world, listener);
    EXPECT_EQ(traceOfStep(rig), "!ba!");
    rig.world.setWorldUserInfo(&host_user_data);
    EXPECT_EQ(traceOfStep(rig), "Hbah");
  }
  EXPECT_EQ(rig.world.getWorldUserInfo(), &host_user_data);
}

TEST(HostWorld, WorksWithoutHostCallbacks) {
  BulletRig rig;
  TracingListener listener;
  {
    const HostWorld attached(rig.world, listener);
    EXPECT_EQ(traceOfStep(rig), "ba");
  }
  EXPECT_EQ(Slots::pre(rig.world), nullptr);
  EXPECT_EQ(traceOfStep(rig), "");
}

TEST_F(HostWorldTest, RefusesASecondAttachAndLeavesTheFirstAlone) {
  const HostWorld attached(rig.world, listener);
  TracingListener second;
  EXPECT_THROW(HostWorld(rig.world, second), Error);
  EXPECT_EQ(traceOfStep(rig), "Hbah");
  EXPECT_TRUE(second.steps.empty());
}

TEST_F(HostWorldTest, CanBeAttachedAgainAfterDetach) {
  for (int i = 0; i < 3; ++i) {
    const HostWorld attached(rig.world, listener);
    EXPECT_EQ(traceOfStep(rig), "Hbah");
  }
  EXPECT_EQ(traceOfStep(rig), "Hh");
}

TEST_F(HostWorldTest, LayerOnTopMayLeaveFirst) {
  {
    const HostWorld attached(rig.world, listener);
    {
      const Layer layer(rig.world);
      EXPECT_EQ(traceOfStep(rig), "HbLlah");
    }
    EXPECT_EQ(traceOfStep(rig), "Hbah");
  }
  EXPECT_EQ(Slots::pre(rig.world), &hostPreTick);
}

TEST_F(HostWorldTest, StaysAsSilentLinkUnderALayer) {
  auto attached = std::make_unique<HostWorld>(rig.world, listener);
  {
    const Layer layer(rig.world);
    attached.reset();
    EXPECT_EQ(traceOfStep(rig), "HLlh");
  }
  // The layer has put our silent callback back on top. It still calls the host's, and works again
  // when needed.
  EXPECT_EQ(traceOfStep(rig), "Hh");
  attached = std::make_unique<HostWorld>(rig.world, listener);
  EXPECT_EQ(traceOfStep(rig), "Hbah");
  attached.reset();
  EXPECT_EQ(Slots::pre(rig.world), &hostPreTick);
  EXPECT_EQ(Slots::post(rig.world), &hostPostTick);
}

TEST_F(HostWorldTest, CanBeAttachedAgainOnTopOfALayerOverItsSilentLink) {
  auto attached = std::make_unique<HostWorld>(rig.world, listener);
  const Layer layer(rig.world);
  attached.reset();
  attached = std::make_unique<HostWorld>(rig.world, listener);
  EXPECT_EQ(traceOfStep(rig), "HLbalh");
  attached.reset();
  EXPECT_EQ(traceOfStep(rig), "HLlh");
}

TEST(HostWorld, DoesNotMistakeANewWorldForOneThatDiedAtItsAddress) {
  // A world is destroyed with our silent callback in its chain. Another world is built in its
  // place.
  alignas(BulletRig) std::byte memory[sizeof(BulletRig)];
  TracingListener listener;
  auto* rig = new (memory) BulletRig;
  auto attached = std::make_unique<HostWorld>(rig->world, listener);
  {
    const Layer layer(rig->world);
    attached.reset();
  }
  rig->~BulletRig();
  rig = new (memory) BulletRig;
  EXPECT_EQ(traceOfStep(*rig), "");
  attached = std::make_unique<HostWorld>(rig->world, listener);
  EXPECT_EQ(traceOfStep(*rig), "ba");
  attached.reset();
  EXPECT_EQ(traceOfStep(*rig), "");
  rig->~BulletRig();
}

class SubStepGrouping : public ::testing::TestWithParam<int> {};

// 16 ms in steps of 1 ms are 16 callbacks of 1 ms each, in any grouping by the host.
TEST_P(SubStepGrouping, GivesEachSubStepItsOwnCallback) {
  constexpr double kStep = 1e-3;  // sub-step of the host [s]
  BulletRig rig;
  TracingListener listener;
  const HostWorld attached(rig.world, listener);
  trace.clear();
  for (int done = 0; done < 16; done += GetParam()) {
    // The small excess keeps float rounding from losing a sub-step.
    rig.world.stepSimulation(static_cast<btScalar>(GetParam() * kStep + 1e-6), GetParam(),
                             static_cast<btScalar>(kStep));
  }
  ASSERT_EQ(listener.steps.size(), 16u);
  for (const double dt : listener.steps) EXPECT_NEAR(dt, kStep, test::byWidth(1e-18, 1e-10));
  std::string expected;
  for (int i = 0; i < 16; ++i) expected += "ba";
  EXPECT_EQ(trace, expected);
}
INSTANTIATE_TEST_SUITE_P(SubStepsPerCall, SubStepGrouping, ::testing::Values(1, 4, 16));

}  // namespace
}  // namespace tandem
