// Sites over real sockets on loopback. No test asserts times.

#include "c_door/two_meshes.h"

namespace tandem {
namespace {

using namespace test;

// One host moves its cube: both cubes end at one place.
TEST(Mesh, JoinsTwoSites) {
  const TwoMeshes meshes;
  ASSERT_TRUE(meshes.pollUntil([&] { return meshes.areBoth(TANDEM_PEER_LIVE); }));
  TandemLink *to_second = nullptr, *to_first = nullptr, *again = nullptr;
  ok(tandem_mesh_link(meshes.first, 2, &to_second));
  ok(tandem_mesh_link(meshes.second, 1, &to_first));
  ok(tandem_mesh_link(meshes.first, 2, &again));
  EXPECT_EQ(again, to_second);

  const LinkedSite one(1, to_second), two(2, to_first);
  EXPECT_EQ(tandem_mesh_destroy(meshes.first), TANDEM_IN_USE);
  EXPECT_EQ(tandem_link_destroy(to_second), TANDEM_IN_USE);
  const TandemState moved = makeState(Vec3(0.0, 0.02, 0.0));
  ok(tandem_world_set_state(one.world, one.cube, &moved));
  Meeting meeting;
  const bool have_met = meshes.pollUntil([&] {
    // The simulated time runs ahead of the clock and behind it, as with a real host.
    for (const LinkedSite* site : {&one, &two})
      ok(tandem_world_step(site->world, 1.0 / 60.0, 0, 0.0));
    usleep(10000);
    return meeting.look(one, two);
  });
  EXPECT_TRUE(have_met) << meeting.here.position[1] << " " << meeting.there.position[1];
  EXPECT_GT(two.read().packets_taken, 10u);
  EXPECT_EQ(two.read().status, 0u);

  ok(tandem_mesh_leave(meshes.first, readClock()));
  EXPECT_TRUE(meshes.pollUntil([&] { return meshes.phase(meshes.second, 1) == TANDEM_PEER_LEFT; }));
}

TEST(Mesh, SaysWhatIsNotAgreed) {
  const TwoMeshes meshes("0.3");
  ASSERT_TRUE(meshes.pollUntil([&] { return meshes.areBoth(TANDEM_PEER_DIFFERENT); }));
  char text[200];
  std::size_t length = 0;
  ok(tandem_mesh_explain(meshes.first, 2, text, sizeof text, &length));
  EXPECT_STREQ(text, "object.mass is 0.2 here and 0.3 there; make it the same\n");
  EXPECT_EQ(length, std::string(text).size());
  ok(tandem_mesh_explain(meshes.first, 2, text, 12, &length));
  EXPECT_STREQ(text, "object.mass");
  ok(tandem_mesh_explain(meshes.first, 2, nullptr, 0, &length));
}

TEST(Mesh, KnowsItsPeers) {
  const TwoMeshes meshes;
  TandemPeerStatus status{};
  TandemLink* link = nullptr;
  EXPECT_EQ(tandem_mesh_status(meshes.first, 5, 0.0, &status), TANDEM_INVALID_ARGUMENT);
  EXPECT_EQ(tandem_mesh_link(meshes.first, 5, &link), TANDEM_INVALID_ARGUMENT);
  EXPECT_STREQ(tandem_last_error(),
               "peer = 5: must be one of the peers that the mesh was created with");
}

TEST(Mesh, TimeDoesNotRunBack) {
  const TwoMeshes meshes;
  ok(tandem_mesh_poll(meshes.first, 5.0));
  EXPECT_EQ(tandem_mesh_poll(meshes.first, 4.0), TANDEM_INVALID_ARGUMENT);
  ok(tandem_mesh_poll(meshes.first, 5.0));
}

TEST(Key, IsNotOverwritten) {
  const TwoMeshes meshes;
  EXPECT_EQ(tandem_key_create(meshes.key.c_str()), TANDEM_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace tandem
