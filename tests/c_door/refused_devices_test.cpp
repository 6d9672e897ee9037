// Refused calls on devices, links and meshes.

#include "c_door/refusal_rig.h"

namespace tandem {
namespace {

using namespace test;

std::vector<Case> deviceCases() {
  return {
      {"Start", TANDEM_INVALID_ARGUMENT, "start = (nan, 0, 0)",
       [](Scene&) {
         const double start[3] = {kNan, 0.0, 0.0};
         TandemDevice* device = untouched<TandemDevice>();
         const TandemResult result = tandem_device_create_moved(start, kAnyForce, &device);
         EXPECT_EQ(device, untouched<TandemDevice>());
         return result;
       }},
      {"MaxForce", TANDEM_INVALID_ARGUMENT, "max_force = -1",
       [](Scene&) {
         TandemDevice* device = nullptr;
         return tandem_device_create_moved(test::kNothing, {-1.0, 1.0}, &device);
       }},
      {"MaxSlew", TANDEM_INVALID_ARGUMENT, "max_slew = nan",
       [](Scene&) {
         TandemDevice* device = nullptr;
         return tandem_device_create_moved(test::kNothing, {1.0, kNan}, &device);
       }},
      {"SimulatedMass", TANDEM_INVALID_ARGUMENT, "mass",
       [](Scene&) {
         TandemDevice* device = nullptr;
         return tandem_device_create_simulated(0.0, 0.5, test::kNothing, nullptr, &device);
       }},
      {"Guide", TANDEM_INVALID_ARGUMENT, "guide = (0, 0, 0): must be of length 1",
       [](Scene&) {
         TandemDevice* device = nullptr;
         return tandem_device_create_simulated(0.1, 0.5, test::kNothing, test::kNothing, &device);
       }},
      {"NoFunction", TANDEM_INVALID_ARGUMENT, "functions.read is null",
       [](Scene&) {
         TandemDevice* device = nullptr;
         return tandem_device_create({}, kAnyForce, &device);
       }},
      {"MoveNan", TANDEM_INVALID_ARGUMENT, "velocity = (0, nan, 0)",
       [](Scene& scene) {
         const double velocity[3] = {0.0, kNan, 0.0};
         return tandem_device_move(scene.device, test::kNothing, velocity);
       }},
      {"MoveSimulated", TANDEM_INVALID_ARGUMENT, "is for devices of tandem_device_create_moved()",
       [](Scene&) {
         TandemDevice* device = nullptr;
         ok(tandem_device_create_simulated(0.1, 0.5, test::kNothing, nullptr, &device));
         const TandemResult result = tandem_device_move(device, test::kNothing, test::kNothing);
         const std::string words = tandem_last_error();
         ok(tandem_device_destroy(device));
         EXPECT_EQ(words, tandem_last_error());
         return result;
       }},
      {"InUse", TANDEM_IN_USE, "the device is used by a site",
       [](Scene& scene) { return tandem_device_destroy(scene.device); }},
      {"LinkInUse", TANDEM_IN_USE, "the link is used by a site",
       [](Scene& scene) { return tandem_link_destroy(scene.link); }},
      {"NetworkLoss", TANDEM_INVALID_ARGUMENT, "loss",
       [](Scene&) {
         TandemNetwork network{};
         network.loss = 2.0;
         TandemLink *first = untouched<TandemLink>(), *second = untouched<TandemLink>();
         const TandemResult result = tandem_link_create_simulated(&network, &first, &second);
         EXPECT_EQ(first, untouched<TandemLink>());
         EXPECT_EQ(second, untouched<TandemLink>());
         return result;
       }},
      {"PushTooMuch", TANDEM_INVALID_ARGUMENT, "object_count = 9: must be at most",
       [](Scene& scene) {
         TandemPacket packet{};
         packet.object_count = 9;
         return tandem_link_push(scene.loose, &packet);
       }},
      {"PushSimulated", TANDEM_INVALID_ARGUMENT, "tandem_link_create_manual()",
       [](Scene&) {
         const TandemNetwork network{};
         TandemLink *first = nullptr, *second = nullptr;
         ok(tandem_link_create_simulated(&network, &first, &second));
         const TandemPacket packet{};
         const TandemResult result = tandem_link_push(first, &packet);
         ok(tandem_link_destroy(second));
         ok(tandem_link_destroy(first));
         return result;
       }},
  };
}

std::vector<Case> meshCases() {
  const auto create = [](const char* bind, TandemMeshPeer peer) {
    TandemMesh* mesh = untouched<TandemMesh>();
    const TandemResult result = tandem_mesh_create(1, bind, 1, &peer, 0, nullptr, &mesh);
    EXPECT_EQ(mesh, untouched<TandemMesh>());
    return result;
  };
  return {
      {"Self", TANDEM_INVALID_ARGUMENT, "self = 0",
       [](Scene&) {
         TandemMesh* mesh = nullptr;
         return tandem_mesh_create(0, "127.0.0.1:0", 0, nullptr, 0, nullptr, &mesh);
       }},
      {"KeyFile", TANDEM_INVALID_ARGUMENT, "no_such_key",
       [create](Scene&) {
         return create("127.0.0.1:0", {2, nullptr, "no_such_key"});
       }},
      {"NoKeyFile", TANDEM_INVALID_ARGUMENT, "key_file of a peer is null",
       [create](Scene&) {
         return create("127.0.0.1:0", {2, nullptr, nullptr});
       }},
      {"Address", TANDEM_INVALID_ARGUMENT, "nowhere",
       [create](Scene&) {
         return create("127.0.0.1:0", {2, "nowhere", nullptr});
       }},
      {"Agreement", TANDEM_INVALID_ARGUMENT, "a key with spaces",
       [](Scene&) {
         const TandemAgreement agreement{"a key with spaces", "1"};
         TandemMesh* mesh = nullptr;
         return tandem_mesh_create(1, "127.0.0.1:0", 0, nullptr, 1, &agreement, &mesh);
       }},
      {"KeyPath", TANDEM_INVALID_ARGUMENT, "path is null",
       [](Scene&) { return tandem_key_create(nullptr); }},
  };
}

INSTANTIATE_TEST_SUITE_P(DevicesAndLinks, Refused, ::testing::ValuesIn(deviceCases()), nameOf);
INSTANTIATE_TEST_SUITE_P(Meshes, Refused, ::testing::ValuesIn(meshCases()), nameOf);

}  // namespace
}  // namespace tandem
