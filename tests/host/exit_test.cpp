// A program calls exit() with everything alive: links open, the haptic thread running. Statics are
// destroyed in reverse order of construction, so the world may end before the site, or after it.

#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/link_queue.h"
#include "tandem/plugin/site.h"
#include "tandem/plugin/udp_mesh.h"
#include "tandem/plugin/udp_socket.h"

#include "host/any_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::FakeDevice;
using test::WorldKind;

constexpr PeerId kRemote{2};

UdpMeshSettings makeMeshSettings() {
  UdpMeshSettings settings;
  settings.bind = resolveAddress("127.0.0.1:0");
  settings.configuration = makeConfiguration({{"object.mass", "0.2"}});
  return settings;
}

std::vector<UdpPeer> makePeers() {
  std::vector<UdpPeer> peers;
  peers.push_back({kRemote, resolveAddress("127.0.0.1:9"), SecretKey::generate()});
  return peers;
}

void runUntilTheEnd(AnyHost& host, UdpMesh& mesh, Site& site) {
  site.share(host.addCube(0.2));
  site.connect(kRemote, mesh.link(kRemote), Vec3(0.1, 0.0, 0.0));
  for (int i = 0; i < 10; ++i) {
    mesh.poll(i / 60.0);
    host.step(1.0 / 60.0);
  }
  std::exit(site.status() == kTickOk ? 0 : 1);
}

struct Exit : ::testing::Test {
  Exit() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};
using ExitDeathTest = Exit;

TEST_F(ExitDeathTest, WithALinkOpenAndTheSiteGoingFirst) {
  EXPECT_EXIT(
      {
        static FakeDevice device;
        static AnyHost host(WorldKind::kDiscrete);
        static UdpMesh mesh(makeMeshSettings(), makePeers());
        static Site site({}, *host.world, device);
        runUntilTheEnd(host, mesh, site);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(ExitDeathTest, WithALinkOpenAndTheWorldGoingFirst) {
  EXPECT_EXIT(
      {
        static std::unique_ptr<Site> site;
        static FakeDevice device;
        static AnyHost host(WorldKind::kDiscrete);
        static UdpMesh mesh(makeMeshSettings(), makePeers());
        site = std::make_unique<Site>(SiteSettings{}, *host.world, device);
        runUntilTheEnd(host, mesh, *site);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(ExitDeathTest, FromTheMiddleOfMainWithALinkOpen) {
  EXPECT_EXIT(
      {
        // These objects are never destroyed.
        FakeDevice device;
        AnyHost host(WorldKind::kDiscrete);
        UdpMesh mesh(makeMeshSettings(), makePeers());
        Site site({}, *host.world, device);
        runUntilTheEnd(host, mesh, site);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(ExitDeathTest, WithAHapticThreadRunningAndTheWorldGoingFirst) {
  EXPECT_EXIT(
      {
        static FakeDevice device;
        static LinkQueue link;
        static std::unique_ptr<Site> site;
        static std::unique_ptr<HapticLoop> loop;
        static AnyHost host(WorldKind::kDiscrete);
        SiteSettings settings;
        settings.tick_source = TickSource::kCaller;
        site = std::make_unique<Site>(settings, *host.world, device);
        site->share(host.addCube(0.2));
        site->connect(kRemote, link, Vec3(0.1, 0.0, 0.0));
        HapticLoopSettings modest;
        modest.priority = 0;
        modest.locks_memory = false;
        loop = std::make_unique<HapticLoop>(*site, modest);
        for (int i = 0; i < 5; ++i) host.step(1.0 / 60.0);
        std::exit(0);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace tandem
