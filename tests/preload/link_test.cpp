// Two preloaded hosts, each in its process, with the key of one pair. Their copies of a cube are
// one object once each has heard the other.

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tandem/plugin/key_file.h"
#include "tandem/plugin/udp_mesh.h"

#include "preload/preload_run.h"

namespace tandem::test {
namespace {

std::string makeConfig(int self, const Address& own, const Address& other, double force) {
  return "object = \"box 0.04 0.04 0.04\"\nlog = \"log" + std::to_string(self) + ".csv\"\n" +
         "[site]\nself = " + std::to_string(self) + "\n[device]\nstart = [" +
         (self == 1 ? "-0.03" : "0.03") + ", 0, 0.02]\nforce = [" + std::to_string(force) +
         ", 0, 0]\n[link]\npeer = " + std::to_string(3 - self) + "\nbind = \"" + toString(own) +
         "\"\naddress = \"" + toString(other) + "\"\nkey = \"pair.psk\"\n";
}

/// Two ports that were free a moment ago.
std::pair<Address, Address> findPorts(const std::string& key) {
  const auto bindAny = [&](PeerId self, PeerId other) {
    UdpMeshSettings settings;
    settings.self = self;
    settings.bind = resolveAddress("127.0.0.1:0");
    settings.configuration = makeConfiguration({{"units", "SI"}});
    std::vector<UdpPeer> peers;
    peers.push_back({other, resolveAddress("127.0.0.1:9"), readKeyFile(key)});
    return std::make_unique<UdpMesh>(settings, std::move(peers));
  };
  const auto first = bindAny(PeerId{1}, PeerId{2});
  const auto second = bindAny(PeerId{2}, PeerId{1});
  return {first->bound(), second->bound()};
}

TEST(PreloadedHosts, ShareOneObjectOverUdp) {
  const TempFolder folder;
  makeKeyFile(folder / "pair.psk");
  const auto [first, second] = findPorts(folder / "pair.psk");
  folder.write("1.toml", makeConfig(1, first, second, 1.0));
  folder.write("2.toml", makeConfig(2, second, first, 0.0));
  const std::string start = std::string("LD_PRELOAD=") + TANDEM_PRELOAD_LIBRARY +
                            " TANDEM_PRELOAD=" + folder.path().string();
  const std::string host =
      std::string(TANDEM_FLOAT64_HOST) + " --world world_first --steps 240 --realtime";
  const Outcome outcome = runProgram(
      "/bin/sh", {"-c", start + "/1.toml " + host + " & " + start + "/2.toml " + host + "; wait"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("site 1 is live"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("site 2 is live"), std::string::npos) << outcome.err;
  // Gains return while the copies move apart, which may take the whole run.
  for (const char* log : {"log1.csv", "log2.csv"})
    EXPECT_NE(readFile(folder / log).find(",rejoining\n"), std::string::npos) << log;

  // Only the first user pushes, and both cubes move.
  double x[2] = {};
  std::size_t at = 0;
  for (double& place : x) {
    ASSERT_EQ(std::sscanf(outcome.out.c_str() + at, "hash %*s cube %lf", &place), 1) << outcome.out;
    at = outcome.out.find('\n', at) + 1;
  }
  EXPECT_GT(std::min(x[0], x[1]), 0.05) << outcome.out;
}

}  // namespace
}  // namespace tandem::test
