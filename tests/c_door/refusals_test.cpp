// What the door refuses: the result, the words, and that nothing has changed.

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "bridge/bullet_rig.h"
#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

const double kNan = std::nan("");

/// A scene of all that refusals are about.
struct Scene : LoneDoorProxy {
  TandemBody cube = TANDEM_NO_BODY, wall = TANDEM_NO_BODY;
  TandemWorld* bare = test::makeWorld();
  TandemDevice* spare = nullptr;
  TandemLink* loose = nullptr;
  BulletRig rig;
  TandemWorld* hosts = nullptr;

  Scene() : LoneDoorProxy(test::makeWorld()) {
    TandemBodySettings body = tandem_default_body_settings();
    body.start = makeState(Vec3(0.0, 1.0, 0.0));
    ok(tandem_world_add_body(world, &body, &cube));
    body.mass = 0.0;
    body.start = makeState(Vec3(0.0, 2.0, 0.0));
    ok(tandem_world_add_body(world, &body, &wall));
    ok(tandem_site_share(site, cube, 0.0, nullptr));
    ok(tandem_device_create_moved(kFarAway, kAnyForce, &spare));
    ok(tandem_link_create_manual(&loose));
    ok(tandem_world_attach(&rig.world, TANDEM_ATTACH_ABI, &hosts));
    ok(tandem_world_step(world, 1.0 / 60.0, 0, 0.0));
  }
  ~Scene() {
    ok(tandem_world_destroy(bare));
    ok(tandem_world_destroy(hosts));
    ok(tandem_device_destroy(spare));
    ok(tandem_link_destroy(loose));
  }

  /// All that can be asked, in numbers.
  [[nodiscard]] std::vector<double> look() const {
    const TandemReading now = read();
    std::vector<double> all{
        static_cast<double>(now.ticks),        static_cast<double>(now.state_hash >> 11U),
        static_cast<double>(now.status),       static_cast<double>(now.object_count),
        static_cast<double>(now.remote_count), static_cast<double>(now.packets_taken)};
    for (const TandemBody each : {cube, wall, proxy}) {
      const TandemState state = body(each);
      all.insert(all.end(), state.position, state.position + 3);
      all.insert(all.end(), state.velocity, state.velocity + 3);
    }
    return all;
  }
};

struct Case {
  const char* name;
  TandemResult result;
  const char* words;
  std::function<TandemResult(Scene&)> call;
};

TandemBodySettings spoilBody(const std::function<void(TandemBodySettings&)>& spoil) {
  TandemBodySettings settings = tandem_default_body_settings();
  spoil(settings);
  return settings;
}
TandemSiteSettings spoilSite(const std::function<void(TandemSiteSettings&)>& spoil) {
  TandemSiteSettings settings = tandem_default_site_settings();
  spoil(settings);
  return settings;
}

/// As another language may do it: no C++ enumeration may hold such a number.
template <typename Enumeration>
void setNumber(Enumeration& enumeration, int number) {
  static_assert(sizeof enumeration == sizeof number);
  std::memcpy(&enumeration, &number, sizeof number);
}

/// A value that no function may write.
template <typename Handle>
Handle* untouched() {
  static int place = 0;
  return reinterpret_cast<Handle*>(&place);
}

TandemResult add(Scene& scene, const TandemBodySettings& settings) {
  TandemBody body = 77;
  const TandemResult result = tandem_world_add_body(scene.bare, &settings, &body);
  EXPECT_EQ(body, 77u);
  return result;
}
Case addCase(const char* name, const char* words,
             const std::function<void(TandemBodySettings&)>& spoil) {
  return {name, TANDEM_INVALID_ARGUMENT, words,
          [spoil](Scene& scene) { return add(scene, spoilBody(spoil)); }};
}

Case siteCase(const char* name, const char* words,
              const std::function<void(TandemSiteSettings&)>& spoil) {
  return {name, TANDEM_INVALID_ARGUMENT, words, [spoil](Scene& scene) {
            const TandemSiteSettings settings = spoilSite(spoil);
            TandemSite* site = untouched<TandemSite>();
            const TandemResult result =
                tandem_site_create(&settings, scene.bare, scene.spare, &site);
            EXPECT_EQ(site, untouched<TandemSite>());
            return result;
          }};
}

std::vector<Case> bodyCases() {
  return {
      addCase("Cookie", "not from tandem_default_body_settings()",
              [](auto& s) { s = TandemBodySettings{}; }),
      addCase("Kind", "shape = 17: must be one of TandemShapeKind",
              [](auto& s) { setNumber(s.shape, 17); }),
      addCase("Size", "half_extents.y", [](auto& s) { s.size[1] = 0.0; }),
      addCase("SizeNan", "half_extents.y", [](auto& s) { s.size[1] = kNan; }),
      addCase("Mass", "mass = -1: must be finite, 0 or more", [](auto& s) { s.mass = -1.0; }),
      addCase("MassTiny", "large enough for Bullet's scalars", [](auto& s) { s.mass = 1e-320; }),
      addCase("Inertia", "inertia = 1 0 1", [](auto& s) { s.inertia[0] = s.inertia[2] = 1.0; }),
      addCase("Friction", "friction = -0.5", [](auto& s) { s.friction = -0.5; }),
      addCase("Restitution", "restitution = 2: must be 0 to 1",
              [](auto& s) { s.restitution = 2.0; }),
      addCase("Start", "start.position = (0, nan, 0): must be finite",
              [](auto& s) { s.start.position[1] = kNan; }),
      addCase("Orientation", "start.orientation = (0, 0, 0, 2): must be x, y, z, w of length 1",
              [](auto& s) { s.start.orientation[3] = 2.0; }),
      addCase("StaticVelocity", "static body",
              [](auto& s) { s.mass = 0.0, s.start.velocity[0] = 1.0; }),
      addCase("PlaneMass", "mass of a plane = 0.2: must be 0",
              [](auto& s) { s.shape = TANDEM_PLANE; }),
      addCase("HullNull", "points is null", [](auto& s) { s.shape = TANDEM_HULL; }),
      addCase("HullFlat", "one plane",
              [](auto& s) {
                static const double flat[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
                s.shape = TANDEM_HULL, s.points = flat, s.point_count = 4;
              }),
      {"HostsWorld", TANDEM_INVALID_ARGUMENT, "the world is the host's",
       [](Scene& scene) {
         const TandemBodySettings settings = tandem_default_body_settings();
         TandemBody body = 0;
         return tandem_world_add_body(scene.hosts, &settings, &body);
       }},
      {"NotInTheWorld", TANDEM_INVALID_ARGUMENT, "not in this Bullet world",
       [](Scene& scene) {
         btSphereShape shape(btScalar(1));
         btRigidBody stray(1, nullptr, &shape);
         TandemBody body = 0;
         return tandem_world_find_body(scene.hosts, &stray, &body);
       }},
      {"Unknown", TANDEM_INVALID_ARGUMENT, "body 99 is none of this world",
       [](Scene& scene) {
         TandemState state{};
         const TandemBody body = 99;
         return tandem_world_get_states(scene.world, 1, &body, &state);
       }},
      {"NoBody", TANDEM_INVALID_ARGUMENT, "TANDEM_NO_BODY",
       [](Scene& scene) { return tandem_world_remove_body(scene.world, TANDEM_NO_BODY); }},
      {"RemoveShared", TANDEM_IN_USE, "is shared by a site",
       [](Scene& scene) { return tandem_world_remove_body(scene.world, scene.cube); }},
      {"RemoveProxy", TANDEM_IN_USE, "or its proxy",
       [](Scene& scene) { return tandem_world_remove_body(scene.world, scene.proxy); }},
      {"SetNan", TANDEM_INVALID_ARGUMENT, "state.velocity = (0, 0, inf): must be finite",
       [](Scene& scene) {
         TandemState state = makeState(Vec3::Zero());
         state.velocity[2] = std::numeric_limits<double>::infinity();
         return tandem_world_set_state(scene.world, scene.cube, &state);
       }},
      {"ForceNan", TANDEM_INVALID_ARGUMENT, "torque = (nan, 0, 0): must be finite",
       [](Scene& scene) {
         const double force[3] = {1.0, 0.0, 0.0}, torque[3] = {kNan, 0.0, 0.0};
         return tandem_world_apply_force(scene.world, scene.cube, force, torque);
       }},
      {"TakenOut", TANDEM_CANNOT, "was taken out of the world by the host",
       [](Scene& scene) {
         btRigidBody& rigid = scene.rig.addCube(1.0);
         TandemBody body = 0;
         ok(tandem_world_find_body(scene.hosts, &rigid, &body));
         scene.rig.world.removeRigidBody(&rigid);
         TandemState state{};
         const TandemResult result = tandem_world_get_states(scene.hosts, 1, &body, &state);
         scene.rig.world.addRigidBody(&rigid);
         return result;
       }},
  };
}

std::vector<Case> worldCases() {
  const auto begin = [](Scene& scene, std::vector<TandemBody> bodies, double dt) {
    std::vector<TandemState> states(bodies.size(), makeState(Vec3::Zero()));
    return tandem_world_begin_step(scene.world, dt, nullptr, bodies.size(), bodies.data(),
                                   states.data(), states.data());
  };
  return {
      {"Null", TANDEM_INVALID_ARGUMENT, "the world is null",
       [](Scene&) { return tandem_world_step(nullptr, 1.0, 0, 0.0); }},
      {"NoPlace", TANDEM_INVALID_ARGUMENT, "world is null; give the address of one",
       [](Scene&) { return tandem_world_create(nullptr); }},
      {"WrongKind", TANDEM_INVALID_ARGUMENT, "the world is none",
       [](Scene& scene) {
         return tandem_world_step(reinterpret_cast<TandemWorld*>(scene.device), 1.0, 0, 0.0);
       }},
      {"Twice", TANDEM_INVALID_ARGUMENT, "has been destroyed already",
       [](Scene&) {
         TandemWorld* world = test::makeWorld();
         ok(tandem_world_destroy(world));
         return tandem_world_destroy(world);
       }},
      {"InUse", TANDEM_IN_USE, "the world is used by a site; destroy that first",
       [](Scene& scene) { return tandem_world_destroy(scene.world); }},
      {"Width", TANDEM_WRONG_BULLET, "Bullet scalar width mismatch",
       [](Scene& scene) {
         TandemWorld* world = untouched<TandemWorld>();
         const TandemResult result = tandem_world_attach(
             &scene.rig.world, 12 - tandem_scalar_bytes(), BT_BULLET_VERSION, &world);
         EXPECT_EQ(world, untouched<TandemWorld>());
         return result;
       }},
      {"Version", TANDEM_WRONG_BULLET, "Bullet version mismatch",
       [](Scene& scene) {
         TandemWorld* world = nullptr;
         return tandem_world_attach(&scene.rig.world, tandem_scalar_bytes(), 9, &world);
       }},
      {"NoHost", TANDEM_INVALID_ARGUMENT, "discrete_dynamics_world is null",
       [](Scene&) {
         TandemWorld* world = nullptr;
         return tandem_world_attach(nullptr, TANDEM_ATTACH_ABI, &world);
       }},
      {"Gravity", TANDEM_INVALID_ARGUMENT, "gravity = (0, 0, nan)",
       [](Scene& scene) {
         const double gravity[3] = {0.0, 0.0, kNan};
         return tandem_world_set_gravity(scene.world, gravity);
       }},
      {"StepNan", TANDEM_INVALID_ARGUMENT, "dt = nan",
       [](Scene& scene) { return tandem_world_step(scene.world, kNan, 0, 0.0); }},
      {"Substeps", TANDEM_INVALID_ARGUMENT, "max_substeps = -1: must be 0 or more",
       [](Scene& scene) { return tandem_world_step(scene.world, 0.1, -1, 0.1); }},
      {"FixedStep", TANDEM_INVALID_ARGUMENT, "fixed_step = 0",
       [](Scene& scene) { return tandem_world_step(scene.world, 0.1, 4, 0.0); }},
      {"StepOfHosts", TANDEM_INVALID_ARGUMENT, "the world is the host's: tandem_world_step()",
       [](Scene& scene) { return tandem_world_step(scene.hosts, 0.1, 0, 0.0); }},
      {"EndWithoutBegin", TANDEM_INVALID_ARGUMENT, "no step of guests has begun",
       [](Scene& scene) {
         return tandem_world_end_step(scene.world, 0, nullptr, nullptr, nullptr);
       }},
      {"BeginZero", TANDEM_INVALID_ARGUMENT, "dt = 0",
       [begin](Scene& scene) { return begin(scene, {scene.cube}, 0.0); }},
      {"BeginStatic", TANDEM_INVALID_ARGUMENT, "is static, so no guest",
       [begin](Scene& scene) {
         return begin(scene, {scene.cube, scene.wall}, 0.01);
       }},
      {"BeginTwiceTheSame", TANDEM_INVALID_ARGUMENT, "is in `bodies` twice",
       [begin](Scene& scene) {
         return begin(scene, {scene.cube, scene.cube}, 0.01);
       }},
      {"BeginNan", TANDEM_INVALID_ARGUMENT, "now[1].position = (nan, 0, 0): must be finite",
       [](Scene& scene) {
         const TandemBody bodies[2] = {scene.cube, scene.proxy};
         TandemState states[2] = {makeState(Vec3::Zero()), makeState(Vec3(kNan, 0.0, 0.0))};
         return tandem_world_begin_step(scene.world, 0.01, nullptr, 2, bodies, states, states);
       }},
      {"BeginOfHosts", TANDEM_INVALID_ARGUMENT, "the world is the host's",
       [](Scene& scene) {
         return tandem_world_begin_step(scene.hosts, 0.01, nullptr, 0, nullptr, nullptr, nullptr);
       }},
  };
}

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

std::vector<Case> siteCases() {
  return {
      siteCase("Cookie", "not from tandem_default_site_settings()",
               [](auto& s) { s = TandemSiteSettings{}; }),
      siteCase("Self", "self = 0: must be 1 or more", [](auto& s) { s.self = 0; }),
      siteCase("Peers", "peers = 0: must be 1 to 64", [](auto& s) { s.peers = 0; }),
      siteCase("Rate", "haptic_rate = nan", [](auto& s) { s.haptic_rate = kNan; }),
      siteCase("Contact", "contact.stiffness = -1", [](auto& s) { s.contact.stiffness = -1.0; }),
      siteCase("Scheme", "remote_dynamic_proxy", [](auto& s) { s.scheme = "telepathy"; }),
      siteCase("NoScheme", "scheme is null", [](auto& s) { s.scheme = nullptr; }),
      siteCase("Guide", "guide = (1, 1, 0): must be of length 1",
               [](auto& s) { s.has_guide = 1, s.guide[1] = 1.0; }),
      siteCase("TickSource", "tick_source", [](auto& s) { setNumber(s.tick_source, 3); }),
      {"DeviceTaken", TANDEM_IN_USE, "the device belongs to another site",
       [](Scene& scene) {
         const TandemSiteSettings settings = tandem_default_site_settings();
         TandemSite* site = nullptr;
         return tandem_site_create(&settings, scene.bare, scene.device, &site);
       }},
      {"WorldTaken", TANDEM_CANNOT, "this Bullet world is attached already",
       [](Scene& scene) {
         const TandemSiteSettings settings = tandem_default_site_settings();
         TandemSite* site = nullptr;
         return tandem_site_create(&settings, scene.world, scene.spare, &site);
       }},
      {"ShareStatic", TANDEM_CANNOT, "is static; give a shared object a mass",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.wall, 0.0, nullptr); }},
      {"ShareTwice", TANDEM_CANNOT, "is shared already",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.cube, 0.0, nullptr); }},
      {"ShareProxy", TANDEM_CANNOT, "is shared already, or a proxy",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.proxy, 0.0, nullptr); }},
      {"ShareDamping", TANDEM_INVALID_ARGUMENT, "damping = -1",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.cube, -1.0, nullptr); }},
      {"ConnectTwice", TANDEM_CANNOT, "peer 2 is connected already",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 2, scene.loose, test::kNothing, nullptr);
       }},
      {"ConnectSelf", TANDEM_INVALID_ARGUMENT, "cannot be its own remote",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 1, scene.loose, test::kNothing, nullptr);
       }},
      {"ConnectNobody", TANDEM_INVALID_ARGUMENT, "peer = 0",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 0, scene.loose, test::kNothing, nullptr);
       }},
      {"ConnectTakenLink", TANDEM_IN_USE, "the link is connected already",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 3, scene.link, test::kNothing, nullptr);
       }},
      {"ConnectNan", TANDEM_INVALID_ARGUMENT, "start = (nan, 0, 0)",
       [](Scene& scene) {
         const double start[3] = {kNan, 0.0, 0.0};
         return tandem_site_connect(scene.site, 3, scene.loose, start, nullptr);
       }},
      {"TickItself", TANDEM_INVALID_ARGUMENT, "make it with TANDEM_TICK_CALLER",
       [](Scene& scene) { return tandem_site_tick(scene.site, 1.0, nullptr); }},
      {"LoopOfHostStep", TANDEM_INVALID_ARGUMENT, "TickSource::kCaller",
       [](Scene& scene) { return tandem_site_start_loop(scene.site, 0); }},
      {"WarningsNull", TANDEM_INVALID_ARGUMENT, "text is null",
       [](Scene& scene) { return tandem_site_warnings(scene.site, nullptr, 10, nullptr); }},
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

class Refused : public ::testing::TestWithParam<Case> {};

TEST_P(Refused, SaysWhyAndChangesNothing) {
  Scene scene;
  const std::vector<double> before = scene.look();
  const TandemResult result = GetParam().call(scene);
  const std::string words = tandem_last_error();
  EXPECT_STREQ(tandem_result_name(result), tandem_result_name(GetParam().result)) << words;
  EXPECT_NE(words.find(GetParam().words), std::string::npos) << words;
  EXPECT_EQ(words.find('\n'), std::string::npos);
  EXPECT_EQ(scene.look(), before);
  // The world goes on.
  ok(tandem_world_step(scene.world, 1.0 / 60.0, 0, 0.0));
  EXPECT_EQ(scene.read().ticks, 34u);
}

std::string nameOf(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Bodies, Refused, ::testing::ValuesIn(bodyCases()), nameOf);
INSTANTIATE_TEST_SUITE_P(Worlds, Refused, ::testing::ValuesIn(worldCases()), nameOf);
INSTANTIATE_TEST_SUITE_P(DevicesAndLinks, Refused, ::testing::ValuesIn(deviceCases()), nameOf);
INSTANTIATE_TEST_SUITE_P(Sites, Refused, ::testing::ValuesIn(siteCases()), nameOf);
INSTANTIATE_TEST_SUITE_P(Meshes, Refused, ::testing::ValuesIn(meshCases()), nameOf);

TEST(LastError, IsCutAtAWholeCharacter) {
  std::string path;
  for (int i = 0; i < 600; ++i) path += "\u00e4";
  EXPECT_EQ(tandem_key_create(("/nowhere/" + path).c_str()), TANDEM_INVALID_ARGUMENT);
  const std::string words = tandem_last_error();
  EXPECT_LE(words.size(), 512u);
  EXPECT_GE(words.size(), 510u);
  EXPECT_NE(words.back(), '\xc3');
}

TEST(ResultNames, AreThoseOfTheHeader) {
  EXPECT_STREQ(tandem_result_name(TANDEM_OK), "TANDEM_OK");
  EXPECT_STREQ(tandem_result_name(TANDEM_IN_USE), "TANDEM_IN_USE");
  EXPECT_STREQ(tandem_result_name(TANDEM_INTERNAL), "TANDEM_INTERNAL");
}

TEST(Version, IsTheProjects) { EXPECT_STREQ(tandem_version(), TANDEM_VERSION); }

TEST(DestroyingNull, DoesNothing) {
  EXPECT_EQ(tandem_world_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_device_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_link_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_mesh_destroy(nullptr), TANDEM_OK);
  EXPECT_EQ(tandem_site_destroy(nullptr), TANDEM_OK);
}

}  // namespace
}  // namespace tandem
