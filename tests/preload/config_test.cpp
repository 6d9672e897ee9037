// Valid config files, and the messages for invalid ones.

#include <filesystem>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tandem/plugin/key_file.h"

#include "coordination/src/geometry/compound_parts.h"
#include "preload/adaptor/preload_config.h"
#include "preload/interposer/process.h"
#include "program/process.h"

namespace tandem::test {
namespace {

using preload::findProcessKey;
using preload::parseShapeWords;
using preload::PreloadConfig;
using preload::readPreloadConfig;

class PreloadConfigFile : public testing::Test {
 protected:
  [[nodiscard]] PreloadConfig read(const std::string& text) const {
    return readPreloadConfig(folder_.write("c.toml", text));
  }
  void expectRefused(const std::string& text, const std::vector<std::string>& words) const {
    SCOPED_TRACE(text);
    try {
      (void)read(text);
      ADD_FAILURE() << "was accepted";
    } catch (const Error& error) {
      const std::string line = error.what();
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      EXPECT_NE(line.find(folder_ / "c.toml"), std::string::npos) << line;
      for (const std::string& word : words)
        EXPECT_NE(line.find(word), std::string::npos) << '"' << word << "\" in: " << line;
    }
  }

  TempFolder folder_;
};

TEST_F(PreloadConfigFile, HasDefaultsForAllButTheObject) {
  const PreloadConfig config = read("object = 2\n");
  EXPECT_EQ(config.index, 2);
  EXPECT_FALSE(config.shape || config.mass || config.link);
  EXPECT_EQ(config.world, 1);
  EXPECT_EQ(config.site.peers, 1);
  EXPECT_EQ(config.site.contact.stiffness, SiteSettings{}.contact.stiffness);
  EXPECT_TRUE(config.log.empty());
}

TEST_F(PreloadConfigFile, SetsWhatItNames) {
  const PreloadConfig config = read(R"(
process = "host"
bullet = "float64"
world = 3
object = "box 0.1 0.1 0.2"
mass = 0.5
damping = 2
guide = [0, 1, 0]
log = "out.csv"
[site]
haptic_rate = 2000
packet_rate = 64
[contact]
stiffness = 3000
[coordination]
damping = 20
[proxy]
radius = 0.02
[device]
start = [1, 2, 3]
force = [4, 0, 0]
max_force = 9
)");
  EXPECT_EQ(config.process, "host");
  EXPECT_EQ(config.scalar_bytes, sizeof(double));
  EXPECT_EQ(config.world, 3);
  EXPECT_EQ(config.shape->sizes, (std::vector<double>{0.1, 0.1, 0.2}));
  EXPECT_EQ(config.mass, 0.5);
  EXPECT_EQ(config.damping, 2.0);
  EXPECT_EQ(config.site.guide, Vec3::UnitY());
  EXPECT_EQ(config.device.guide, Vec3::UnitY());
  EXPECT_EQ(config.log, folder_ / "out.csv");
  EXPECT_EQ(config.site.haptic_rate, 2000.0);
  EXPECT_EQ(config.site.packet_rate, 64.0);
  EXPECT_EQ(config.site.contact.stiffness, 3000.0);
  EXPECT_EQ(config.site.coordination.damping, 20.0);
  EXPECT_EQ(config.site.hip_radius, 0.02);
  EXPECT_EQ(config.device.start_W, Vec3(1, 2, 3));
  EXPECT_EQ(config.hand_force_W, Vec3(4, 0, 0));
  EXPECT_EQ(config.device.max_force, 9.0);
}

TEST_F(PreloadConfigFile, WithALinkSharesWithOneMoreSite) {
  makeKeyFile(folder_ / "k.psk");
  const PreloadConfig config = read(
      "object = 1\nsite.self = 2\n[link]\npeer = 1\nbind = \"127.0.0.1:7002\"\n"
      "address = \"127.0.0.1:7001\"\nkey = \"k.psk\"\nplayout = false\n");
  ASSERT_TRUE(config.link);
  EXPECT_EQ(config.site.peers, 2);
  EXPECT_EQ(config.site.self, PeerId{2});
  EXPECT_EQ(config.link->peer, PeerId{1});
  EXPECT_EQ(config.link->bind.port, 7002);
  EXPECT_EQ(config.link->address->port, 7001);
  EXPECT_EQ(config.link->key, folder_ / "k.psk");
  EXPECT_FALSE(config.link->playout);
  EXPECT_FALSE(config.site.link_loss.start_live);
}

TEST_F(PreloadConfigFile, IsRefusedByALineThatNamesKeyAndRemedy) {
  expectRefused("", {"object", "missing"});
  expectRefused("object = 1\nmas = 1\n", {"mas", "no such key", "mass"});
  expectRefused("object = 1\n[devcie]\nforce = [1,0,0]\n", {"devcie", "no such key"});
  expectRefused("object = 0\n", {"object = 0", "whole number from 1"});
  expectRefused("object = \"bxo\"\n", {"object", "bxo", "sphere 0.05"});
  expectRefused("object = \"box 1 2\"\n", {"object", "box 1 2"});
  expectRefused("object = 1.5\n", {"object", "1.5"});
  expectRefused("object = 1\nmass = -1\n", {"mass = -1", "above 0"});
  expectRefused("object = 1\nmass = nan\n", {"mass", "above 0"});
  expectRefused("object = 1\nworld = 0\n", {"world = 0"});
  expectRefused("object = 1\nguide = [1, 1, 0]\n", {"guide", "norm 1"});
  expectRefused("object = 1\nbullet = \"double\"\n", {"bullet", "float64"});
  expectRefused("object = 1\n[device]\nforce = 5\n", {"device.force = 5", "three numbers"});
  expectRefused("object = 1\n[device]\nforce = [1, 2]\n", {"device.force", "three numbers"});
  expectRefused("object = \n", {":1: not TOML"});
  expectRefused("object = 1\n[site]\npacket_rate = 5000\n", {"packet_rate", "5000"});
  expectRefused("object = 1\n[link]\nkey = \"k\"\n", {"link.bind", "missing"});
  expectRefused("object = 1\n[link]\nbind = \":7001\"\n", {"link.key", "missing"});
  expectRefused("object = 1\n[link]\npeer = 1\nbind = \":7001\"\nkey = \"k\"\n",
                {"link.peer", "self"});
  expectRefused("object = 1\n[link]\nbind = \"nonsense\"\nkey = \"k\"\n", {"link.bind"});
}

TEST_F(PreloadConfigFile, ThatIsNotThereIsNamed) {
  try {
    (void)readPreloadConfig(folder_ / "none.toml");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("none.toml: cannot read"), std::string::npos);
  }
}

TEST_F(PreloadConfigFile, NestsAtMost64Deep) {
  std::string key = "object";
  for (int i = 0; i < 40'000; ++i) key += ".a";
  expectRefused("# 1\n" + key + " = 1\n", {":2:", "64 deep"});
}

TEST_F(PreloadConfigFile, IsNoDeviceNoPipeAndNotTooLarge) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string large = folder_.write("large", std::string((1 << 20) + 1, '#'));
  for (const std::string& file : {pipe, std::string("/dev/zero"), large}) {
    EXPECT_TRUE(preload::isWanted(file.c_str())) << file;  // the adaptor gives the reason
    EXPECT_THROW((void)readPreloadConfig(file), Error) << file;
  }
}

TEST(ShapeWords, MatchWithinAThousandth) {
  const auto box = *parseShapeWords("box 0.1 0.1 0.2");
  EXPECT_TRUE(matches(*parseShapeWords("box"), box));
  EXPECT_TRUE(matches(*parseShapeWords("box 0.10005 0.1 0.2"), box));
  EXPECT_FALSE(matches(*parseShapeWords("box 0.1002 0.1 0.2"), box));
  EXPECT_FALSE(matches(*parseShapeWords("box 0.2 0.1 0.1"), box));
  EXPECT_FALSE(matches(*parseShapeWords("sphere"), box));
  EXPECT_FALSE(parseShapeWords("sphere -1"));
  EXPECT_FALSE(parseShapeWords("sphere 1 x"));
  EXPECT_FALSE(parseShapeWords(""));
}

TEST(ShapeWords, AreThoseOfAShape) {
  EXPECT_EQ(toText(preload::describeShape(Box{Vec3(0.05, 0.1, 0.15)})), "box 0.1 0.2 0.3");
  EXPECT_EQ(toText(preload::describeShape(Sphere{0.05})), "sphere 0.05");
  EXPECT_EQ(toText(preload::describeShape(Capsule{0.05, 0.1, Axis::kX})), "capsule 0.05 0.2");
  EXPECT_EQ(toText(preload::describeShape(Cylinder{0.05, 0.1, Axis::kX})), "cylinder 0.05 0.2");
  EXPECT_EQ(toText(preload::describeShape(Cone{0.05, 0.1, Axis::kX, 0.01})), "cone 0.05 0.2");
  const Compound compound = makeCompound({{Sphere{0.1}, Vec3(1.0, 0.0, 0.0)}, {Cone{0.05, 0.1}}});
  EXPECT_EQ(toText(preload::describeShape(compound)), "compound");
  const auto words = preload::parseShapeWords("compound");
  ASSERT_TRUE(words);
  EXPECT_TRUE(preload::matches(*words, preload::describeShape(compound)));
  EXPECT_FALSE(preload::parseShapeWords("compound 1"));
  EXPECT_EQ(toText(preload::describeShape(Plane{})), "");
}

std::string processOf(const char* text) {
  char name[16];
  return findProcessKey(text, name, sizeof name) ? name : "(none)";
}

TEST(ProcessKey, IsALineBeforeTheFirstTable) {
  EXPECT_EQ(processOf("object = 1\n  process = \"gz\"  # ours\n"), "gz");
  EXPECT_EQ(processOf("process='gz'"), "gz");
  EXPECT_EQ(processOf("# process = \"gz\"\n"), "(none)");
  EXPECT_EQ(processOf("[device]\nprocess = \"gz\"\n"), "(none)");
  EXPECT_EQ(processOf("process = \"gz\n\""), "(none)");
  EXPECT_EQ(processOf("process = gz"), "(none)");
  EXPECT_EQ(processOf("process"), "(none)");
  EXPECT_EQ(processOf("process ="), "(none)");
  EXPECT_EQ(processOf("processes = \"gz\""), "(none)");
  EXPECT_EQ(processOf("process = \"a name longer than there is room\""), "(none)");
  EXPECT_EQ(processOf(""), "(none)");
}

}  // namespace
}  // namespace tandem::test
