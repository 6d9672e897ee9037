// Bodies that enter with an older state than the island's are moved up to its time among the
// others.

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

const CouplerGains kContact = {2000.0, 3.0};  // [N/m, N s/m]

/// An island with a tool on a spring, and room for two boxes.
struct Late {
  Island island{[] {
    IslandSettings settings;
    settings.obstacle_contact = kContact;
    return settings;
  }()};
  BodyIndex tool, first, second;

  Late() {
    IslandBody body;
    body.shape = Sphere{0.01};
    body.mass = 0.1;
    body.damping = 0.3;
    body.feels_obstacles = true;
    tool = island.addBody(body);
    island.addCoupler(tool, {{500.0, 2.0}, {}});
    first = island.addSlot();
    second = island.addSlot();
    island.prepare();
  }
  void fill(BodyIndex slot, const Vec3& p_W, const Vec3& v_W = Vec3::Zero()) {
    IslandBody box;
    box.shape = Box{Vec3::Constant(0.02)};
    box.mass = 0.2;
    box.inertia_B = Vec3::Constant(0.2 * 0.04 * 0.04 / 6.0);
    box.start.p_W = p_W;
    box.start.v_W = v_W;
    island.fill(slot, box);
  }
  [[nodiscard]] std::vector<RigidState> states() const {
    std::vector<RigidState> all;
    for (BodyIndex b = 0; b < island.bodyCount(); ++b) all.push_back(island.state(b));
    return all;
  }
};

TEST(IslandCatchUp, MovesTheSlotAndNothingElse) {
  Late late, alone;
  for (Late* l : {&late, &alone}) {
    RigidState off;
    off.p_W = Vec3(0.01, 0.0, 0.0);
    l->island.setState(l->tool, off);
    for (int i = 0; i < 20; ++i) l->island.advance(1e-3);
  }
  late.fill(late.first, Vec3(1.0, 0.0, 0.0), Vec3(0.1, 0.0, 0.0));
  late.island.setExternalWrench(late.first, Vec3(0.0, -2.0, 0.0), Vec3::Zero());
  const std::vector<RigidState> states = late.states();
  std::vector<Aside> asides(states.size());
  late.island.catchUp({late.first}, states, states, 0.0375, asides);
  EXPECT_LT((late.island.state(late.first).p_W -
             Vec3(1.0 + 0.1 * 0.0375, -0.5 * 10.0 * 0.0375 * 0.0375, 0.0))
                .norm(),
            1e-14);
  EXPECT_EQ(late.island.state(late.tool).p_W, states[0].p_W);
  EXPECT_EQ(late.island.state(late.tool).v_W, states[0].v_W);
  EXPECT_LT(asides[0].v_W.norm(), 1e-12);
  // The tool continues on its spring as if nothing had happened.
  for (Late* l : {&late, &alone}) l->island.advance(1e-3);
  EXPECT_LT((late.island.state(late.tool).p_W - alone.island.state(alone.tool).p_W).norm(), 1e-15);
}

// The tool's past path crosses the box: the box is pushed, and the tool gets the reaction.
TEST(IslandCatchUp, OthersPassThroughAsTheyWent) {
  Late late;
  late.fill(late.first, Vec3(0.0, 0.0, 0.0));
  std::vector<RigidState> from = late.states(), to = from;
  from[0].p_W = Vec3(-0.04, 0.0, 0.0);
  to[0].p_W = Vec3(-0.02, 0.0, 0.0);
  std::vector<Aside> asides(from.size());
  late.island.catchUp({late.first}, from, to, 0.02, asides);
  const Vec3 given_W = 0.2 * late.island.state(late.first).v_W;
  EXPECT_GT(given_W.x(), 0.02);
  EXPECT_LT((given_W + 0.1 * asides[0].v_W).norm(), 1e-12);
  EXPECT_LT(asides[0].offset_W.x(), 0.0);
}

// Catching up in two parts gives the same path as in one.
TEST(IslandCatchUp, GoesOnWhereTheLastPartEnded) {
  const auto run = [](int parts) {
    Late late;
    late.fill(late.first, Vec3(0.0, 0.0, 0.0));
    std::vector<RigidState> from = late.states(), to = from;
    std::vector<Aside> asides(from.size());
    for (int i = 0; i < parts; ++i) {
      from[0].p_W = Vec3(-0.04 + 0.02 * i / parts, 0.0, 0.0);
      to[0].p_W = Vec3(-0.04 + 0.02 * (i + 1) / parts, 0.0, 0.0);
      late.island.catchUp({late.first}, from, to, 0.02 / parts, asides);
    }
    return late.island.state(late.first);
  };
  EXPECT_LT((run(1).p_W - run(4).p_W).norm(), 1e-9);
  EXPECT_LT((run(1).v_W - run(4).v_W).norm(), 1e-6);
}

// Both bodies are new: each is caught up with the other, in either order.
TEST(IslandCatchUp, TakesSeveralAtOnce) {
  Late late;
  late.fill(late.first, Vec3(0.5, 0.0, 0.0), Vec3(0.2, 0.0, 0.0));
  late.fill(late.second, Vec3(0.0, 0.7, 0.0), Vec3(0.0, 0.1, 0.0));
  const std::vector<RigidState> states = late.states();
  std::vector<Aside> asides(states.size());
  late.island.catchUp({late.second, late.first}, states, states, 0.05, asides);
  EXPECT_LT((late.island.state(late.first).p_W - Vec3(0.51, 0.0, 0.0)).norm(), 1e-14);
  EXPECT_LT((late.island.state(late.second).p_W - Vec3(0.0, 0.705, 0.0)).norm(), 1e-14);
}

// A slot that is moved by hand continues at its velocities, turning too, and pushes bodies that it
// meets.
TEST(IslandSlot, MayBeDriven) {
  Late late;
  IslandBody paddle;
  paddle.shape = Box{Vec3(0.1, 0.005, 0.05)};
  paddle.motion = Motion::kPrescribed;
  paddle.start.p_W = Vec3(0.0, -0.03, 0.0);
  paddle.start.v_W = Vec3(0.0, 0.1, 0.0);
  paddle.start.w_W = Vec3(0.0, 0.0, 0.5);
  late.island.fill(late.first, paddle);
  EXPECT_FALSE(late.island.isDynamic(late.first));
  for (int i = 0; i < 200; ++i) late.island.advance(1e-3);
  const RigidState& state = late.island.state(late.first);
  EXPECT_LT((state.p_W - Vec3(0.0, -0.01, 0.0)).norm(), 1e-12);
  EXPECT_NEAR(Quat(Eigen::AngleAxisd(0.1, Vec3::UnitZ())).angularDistance(state.q_WB), 0.0, 1e-12);
  EXPECT_GT(late.island.state(late.tool).p_W.y(), 1e-3);
}

}  // namespace
}  // namespace tandem
