#include <stdexcept>

#include <gtest/gtest.h>

#include "coordination/src/schemes/remote_user.h"

namespace tandem {
namespace {

TEST(Schemes, AreFoundByName) {
  for (const char* name : {"virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"})
    EXPECT_EQ(findScheme(name).name(), name);
}

TEST(Schemes, UnknownNameListsWhatThereIs) {
  try {
    (void)findScheme("telepathy");
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("telepathy"), std::string::npos);
    for (const Scheme* scheme : allSchemes())
      EXPECT_NE(text.find(scheme->name()), std::string::npos);
  }
}

/// An island with one remote user of a scheme; the user's device moves to 1 cm.
struct Presence {
  Island island{IslandSettings{}};
  RemoteUser user;

  explicit Presence(const char* name) {
    const Scheme& scheme = findScheme(name);
    user = scheme.makeRemoteUser(island, {1.0, {}, {200.0, 30.0}}, {});
    island.prepare();
    scheme.follow(island, user, {Vec3(0.01, 0.0, 0.0), Vec3(0.2, 0.0, 0.0)});
  }
};

TEST(Schemes, VirtualCouplingHasNobodyThere) {
  const Presence presence("virtual_coupling");
  EXPECT_FALSE(presence.user.body);
  EXPECT_EQ(presence.island.bodyCount(), 0);
}

TEST(Schemes, KinematicProxyIsTheReceivedState) {
  Presence presence("kinematic_proxy");
  presence.island.advance(1e-3);
  const RigidState& state = presence.island.state(*presence.user.body);
  EXPECT_EQ(state.p_W, Vec3(0.01, 0.0, 0.0));
  EXPECT_EQ(state.v_W, Vec3(0.2, 0.0, 0.0));
}

// eq. (14) at rest at the origin: F_t = K_t 0.01 + B_t 0.2 = 8 N on m_h = 0.1 kg.
TEST(Schemes, RemoteDynamicProxyIsPulledTowardsTheReceivedState) {
  Presence presence("remote_dynamic_proxy");
  EXPECT_NEAR(presence.island.computeCouplerForce(*presence.user.coupler).x(), 8.0, 1e-12);
  Vec3 f_W, t_W;
  presence.island.computeWrench(*presence.user.body, f_W, t_W);
  EXPECT_NEAR(f_W.x(), 8.0, 1e-12);
}

}  // namespace
}  // namespace tandem
