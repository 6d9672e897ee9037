// The grammar of commands: refusals, their messages, and robustness against any input.

#include <cstdio>

#include "tandem/tandem.h"

#include "plugin_rig.h"
#include "support/random.h"

namespace tandem::test {
namespace {

struct Wrong {
  const char* command;
  int status;
  const char* says;
};

void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.command; }

constexpr int kBad = -10, kOrder = -11, kServer = -12;

class WrongCommand : public ::testing::TestWithParam<Wrong> {};

// Body 0 is a cube, 1 a floor, 2 has joints, 3 maximal coordinates, 4 a mesh, 5 has a mesh beside
// a box, 6 is soft.
TEST_P(WrongCommand, IsRefusedWithTheRemedy) {
  PluginHost host;
  StubBody jointed = makeStubCube(), maximal = makeStubCube(), mesh = makeStubCube(),
           mixed = makeStubCube(), soft = makeStubCube();
  jointed.links = 2;
  maximal.is_multibody = false;
  mesh.shape = {makeStubShape(b3::kMesh, Vec3::Ones())};
  mixed.shape.push_back(makeStubShape(b3::kMesh, Vec3::Ones()));
  soft.is_soft = true;
  soft.is_multibody = false;
  for (const StubBody& body :
       {makeStubCube(), makeStubFloor(), jointed, maximal, mesh, mixed, soft}) {
    host.engine.add(body);
  }
  host.command(kFarHand);
  host.command("site");
  host.command("link kind=manual");
  const double mass = host.engine.bodies.at(0).mass;
  const PluginAnswer answer = host.ask(GetParam().command);
  EXPECT_EQ(answer.status, GetParam().status) << answer.bytes;
  EXPECT_NE(answer.bytes.find(GetParam().says), std::string::npos) << answer.bytes;
  EXPECT_EQ(answer.bytes.find('\n'), std::string::npos) << answer.bytes;
  // The body is unchanged.
  EXPECT_EQ(host.engine.bodies.at(0).mass, mass);
  EXPECT_EQ(host.engine.bodies.at(0).linear_damping, 0.04);
  EXPECT_EQ(host.read()[16], 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Table, WrongCommand,
    ::testing::Values(
        Wrong{"", kBad, "is no command; there are: version"},
        Wrong{"shrae body=0", kBad, "\"shrae\" is no command"},
        Wrong{"share", kBad, "body=... is missing"}, Wrong{"share body", kBad, "key=value"},
        Wrong{"share =0", kBad, "key=value"}, Wrong{"share body=0 body=0", kBad, "given twice"},
        Wrong{"share body=zero", kBad, "not a number"},
        Wrong{"share body=1e99", kBad, "not a number"},
        Wrong{"share body=99999999999", kBad, "not a number"},
        Wrong{"share body=0 mass=3", kBad, "no word mass"},
        Wrong{"share body=0 shape=cone", kBad, "there are box, sphere"},
        Wrong{"share body=0 shape=box size=1,2", kBad, "3 numbers"},
        Wrong{"share body=0 shape=box size=1,2,3,4", kBad, "3 numbers"},
        Wrong{"share body=0 shape=box size=1,nan,1", kBad, "finite"},
        Wrong{"share body=0 shape=box size=0,0,0", -TANDEM_INVALID_ARGUMENT, "0"},
        Wrong{"share body=0 shape=hull", kBad, "four points"},
        Wrong{"share body=0 damping=-1", -TANDEM_INVALID_ARGUMENT, "damping"},
        Wrong{"share body=0 name=\"a b", kBad, "double quote"},
        Wrong{"share body=1", kServer, "static"}, Wrong{"share body=2", kServer, "2 links"},
        Wrong{"share body=3", kServer, "maximal coordinates"},
        Wrong{"share body=4", kServer, "shape=hull"}, Wrong{"share body=5", kServer, "has a mesh"},
        Wrong{"share body=6", kServer, "body 6 is a soft body: Tandem can have rigid bodies only"},
        Wrong{"share body=6 shape=sphere size=1", kServer, "is a soft body"},
        Wrong{"obstacle body=6", kServer, "is a soft body"},
        Wrong{"share body=7", kServer, "no rigid body of this number"},
        Wrong{"share body=-1", kServer, "no rigid body of this number"},
        Wrong{"obstacle body=0", kServer, "moves"},
        Wrong{"device kind=moved", kOrder, "there is a site already: `close` first"},
        Wrong{"device kind=falcon", kBad, "moved and simulated"},
        Wrong{"site", kOrder, "there is a site already: `close` first"},
        Wrong{"link kind=carrier_pigeon", kBad, "simulated, manual and mesh"},
        Wrong{"link kind=mesh peer=2", kOrder, "mesh"},
        Wrong{"link kind=simulated name=a delay=-1", -TANDEM_INVALID_ARGUMENT, "delay"},
        Wrong{"connect peer=2 link=1 start=0,0,0", kBad, "no such link"},
        Wrong{"connect peer=0 link=0 start=0,0,0", kBad, "peer"},
        Wrong{"connect peer=1 link=0 start=0,0,0", -TANDEM_INVALID_ARGUMENT, "its own remote"},
        Wrong{"proxy remote=0 body=0", kBad, "no such remote"},
        Wrong{"hand force=1,0,0", kBad, "position"}, Wrong{"pop link=3", kBad, "no manual link"},
        Wrong{"push link=0", kBad, "13 doubles"},
        Wrong{"mesh self=1 bind=nowhere", -TANDEM_INVALID_ARGUMENT, ""},
        Wrong{"mesh_status peer=2", kOrder, "no mesh"}));

TEST(Arguments, FloatsAreRefusedAsPyBulletRoundsThem) {
  PluginHost host;
  const PluginAnswer answer = host.ask("hand force=1,0,0", {}, 3);
  EXPECT_EQ(answer.status, kBad);
  EXPECT_NE(answer.bytes.find("single precision"), std::string::npos);
}

TEST(Arguments, IntsAreForDataOnly) {
  PluginHost host;
  EXPECT_NE(host.ask("version", {1}).bytes.find("no intArgs"), std::string::npos);
  EXPECT_EQ(host.ask("data", {1, 2}).status, 2);
  EXPECT_EQ(host.ask("data", std::vector<int>(128)).status, 130);
  for (int i = 0; i < 190; ++i) host.ask("data", std::vector<int>(128));
  EXPECT_NE(host.ask("data", std::vector<int>(128)).bytes.find("4096 points: leave out points"),
            std::string::npos);
  EXPECT_EQ(host.ask("data").status, 0);  // a refusal discards the data
}

TEST(Arguments, AHullComesInPieces) {
  PluginHost host;
  StubBody mesh = makeStubCube();
  mesh.shape = {makeStubShape(b3::kMesh, Vec3::Ones())};
  host.engine.add(mesh);
  host.command(kFarHand);
  host.command("site");
  std::vector<double> points;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) points.push_back((corner >> axis & 1) ? 0.02 : -0.02);
  }
  const std::vector<double> head(points.begin(), points.begin() + 15);
  EXPECT_EQ(host.askDoubles("data", head).status, 30);
  const std::vector<double> tail(points.begin() + 15, points.end());
  EXPECT_EQ(host.askDoubles("share body=0 shape=hull", tail).status, 0);
}

// Data of a failed mesh is not there for the next mesh, nor after `close`.
TEST(Mesh, CanBeTriedAgain) {
  const std::string key = testing::TempDir() + "tandem_pybullet_again.key";
  std::remove(key.c_str());
  PluginHost host;
  host.command("key path=\"" + key + "\"");
  const auto sayPeer = [&host](const std::string& file) {
    host.command("peer id=2 address=127.0.0.1:7999 key=\"" + file + "\"");
    host.command("agree key=mass value=1");
  };
  sayPeer("/nonexistent.key");
  EXPECT_NE(host.refusal("mesh self=1 bind=127.0.0.1:0").find("nonexistent"), std::string::npos);
  sayPeer("/nonexistent.key");
  host.command("close");
  sayPeer(key);
  host.command("mesh self=1 bind=127.0.0.1:0");
  host.command("close");
  std::remove(key.c_str());
}

TEST(Site, IsNotOpenWhenItWasRefused) {
  PluginHost host;
  host.engine.gravity.z() = std::nan("");
  host.command(kFarHand);
  EXPECT_NE(host.refusal("site").find("gravity"), std::string::npos);
  EXPECT_NE(host.refusal("read").find("no site yet"), std::string::npos);
  host.engine.gravity.z() = -9.81;
  host.command("site");
}

TEST(Site, TakesABudgetOfPackets) {
  PluginHost host;
  host.command(kFarHand);
  EXPECT_NE(host.refusal("site packet_budget=-1").find("packet_budget = -1"), std::string::npos);
  host.command("site packet_budget=1e6");
}

TEST(Order, IsSaidWhereItIsWrong) {
  PluginHost host;
  host.engine.add(makeStubCube());
  EXPECT_NE(host.refusal("site").find("device"), std::string::npos);
  EXPECT_NE(host.refusal("share body=0").find("no site yet"), std::string::npos);
  EXPECT_NE(host.refusal("read").find("no site yet"), std::string::npos);
  EXPECT_NE(host.refusal("hand force=1,0,0").find("no device"), std::string::npos);
  host.command("close");  // nothing is open
  host.command(kFarHand);
  host.command("site");
  host.command("share body=0");
  EXPECT_NE(host.refusal("share body=0").find("attached already"), std::string::npos);
}

// PyBullet loads plugins into the global scope: exported names could replace other functions.
TEST(Exports, AreTheEntryPointsOnly) {
  (void)PluginEntries::get();
  void* const module = dlopen(TANDEM_PYBULLET_PLUGIN, RTLD_NOW | RTLD_NOLOAD);
  ASSERT_NE(module, nullptr);
  EXPECT_NE(dlsym(module, "initPlugin_tandem"), nullptr);
  for (const char* name : {"tandem_world_create", "tandem_version", "processNotifications_tandem",
                           "getCollisionInterface_tandem", "_ZN6tandem4SiteD1Ev"}) {
    EXPECT_EQ(dlsym(module, name), nullptr) << name;
  }
  dlclose(module);
}

TEST(Answers, AreText) {
  PluginHost host;
  EXPECT_FALSE(host.ask("version").bytes.empty());
  SharedCube shared;
  EXPECT_EQ(shared.host.ask("warnings").status, 0);
}

// Words of the grammar, combined at random and damaged. No command crashes, leaks or is half done,
// and a refusal always gives a reason.
TEST(Fuzz, NoCommandBreaksThePlugin) {
  constexpr std::uint64_t kSeed = 20260729;
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  const char* const words[] = {"share",
                               "obstacle",
                               "connect",
                               "proxy",
                               "hand",
                               "read",
                               "push",
                               "pop",
                               "grab",
                               "release",
                               "grip",
                               "object=0",
                               "tool_of=1",
                               "orientation=0,0,0,1",
                               "data",
                               "device",
                               "site",
                               "link",
                               "close",
                               "peer",
                               "agree",
                               "warnings",
                               "body=0",
                               "body=1",
                               "body=2",
                               "shape=box",
                               "shape=hull",
                               "shape=sphere",
                               "size=0.02",
                               "size=0.02,0.02,0.02",
                               "size=1e300,1,1",
                               "damping=1",
                               "kind=moved",
                               "kind=manual",
                               "kind=simulated",
                               "kind=mesh",
                               "name=x",
                               "delay=0.01",
                               "peers=2",
                               "self=1",
                               "peer=2",
                               "link=0",
                               "start=0,0,0",
                               "start=1e308,0,0",
                               "remote=0",
                               "force=1,2,3",
                               "position=0,0,0",
                               "velocity=0,0,0",
                               "guide=0,0,0",
                               "guide=1,0,0",
                               "scheme=none",
                               "id=2",
                               "key=\"a b\"",
                               "value=1",
                               "haptic_rate=1000",
                               "contact=0,0",
                               "contact=-1,0",
                               "=",
                               "\"",
                               ",",
                               "loss=2",
                               "jitter=0.001"};
  Random random(kSeed);
  PluginHost host;
  for (const StubBody& body : {makeStubCube(), makeStubFloor(), makeStubCube()}) {
    host.engine.add(body);
  }
  for (int round = 0; round < 20000; ++round) {
    std::string line;
    for (int i = random.below(6); i >= 0; --i) {
      line += words[random.below(static_cast<int>(std::size(words)))];
      line += ' ';
    }
    for (int i = random.below(3); i > 0; --i) {
      line[static_cast<std::size_t>(random.below(static_cast<int>(line.size())))] =
          static_cast<char>(random.below(256));
    }
    std::vector<int> ints(static_cast<std::size_t>(random.below(8) == 0 ? random.below(129) : 0));
    for (int& word : ints) word = static_cast<int>(random.uniform(-2e9, 2e9));
    const PluginAnswer answer = host.ask(line, ints);
    EXPECT_TRUE(answer.status >= 0 || !answer.bytes.empty()) << line;
    if (random.below(10) == 0) host.step();
  }
}

}  // namespace
}  // namespace tandem::test
