// Two users feel each other by the carrier as by UDP. Time is virtual: a poll takes all that was
// sent before it, so that results depend on the way alone and not on the load of the machine.

#include <array>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"
#include "tandem/plugin/udp_mesh.h"

#include "bridge/bullet_rig.h"
#include "dds/dds_pair.h"
#include "net/virtual_net.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;         // [s]
constexpr double kDuration = 1.0;        // of Experiment I [s]
constexpr int kTicksPerHostStep = 4;     // 250 Hz
constexpr double kHalf = 0.02;           // of the cube's edge [m]
constexpr double kStart = kHalf + 0.01;  // of a hand of 1 cm, just in contact [m]
const Vec3 kPush = Vec3(5.0, 0.0, 0.0);  // user 1's hand; user 2's is empty [N]

/// One end of the bus whose other end says how much it has sent: receive() waits for all of it.
class PromptCarrier final : public DatagramCarrier {
 public:
  explicit PromptCarrier(DdsCarrier& bus) : bus_(bus) {}
  void send(ByteView datagram, PeerId to) noexcept override {
    ++sent_;
    bus_.send(datagram, to);
  }
  std::optional<Received> receive(ByteSpan room) noexcept override {
    while (taken_ < other->sent_) {
      const auto received = bus_.receive(room);
      if (!received && !isWorthWaiting()) break;
      if (!received) continue;
      ++taken_;
      return received;
    }
    return std::nullopt;
  }
  void wait(double seconds) const noexcept override { bus_.wait(seconds); }

  PromptCarrier* other = nullptr;

 private:
  [[nodiscard]] bool isWorthWaiting() noexcept {
    const double begin = test::clockNow();
    bus_.wait(test::kPatience);
    return test::clockNow() < begin + test::kPatience;
  }

  DdsCarrier& bus_;
  std::uint64_t sent_ = 0, taken_ = 0;
};

UdpMesh makeMesh(std::uint32_t self, UdpMeshSettings settings,
                 const std::optional<Address>& other = std::nullopt) {
  settings.self = PeerId{self};
  settings.configuration = makeConfiguration({{"object.mass", "0.2"}});
  std::vector<UdpPeer> peers;
  peers.push_back({PeerId{3 - self}, other, test::makeKey(7)});
  return UdpMesh(settings, std::move(peers));
}

/// A user's world, device and site on a mesh.
struct User {
  User(std::uint32_t self, UdpMesh& own_mesh) : mesh(own_mesh), other(PeerId{3 - self}) {
    SimulatedDeviceSettings handle;
    handle.start_W.x() = self == 1 ? -kStart : kStart;
    handle.guide = Vec3::UnitX();
    device = std::make_unique<SimulatedDevice>(
        handle, makeConstantHand(self == 1 ? kPush : Vec3(Vec3::Zero())));
    SiteSettings settings;
    settings.self = PeerId{self};
    settings.tick_source = TickSource::kCaller;
    settings.host_step = kPeriod * kTicksPerHostStep;
    settings.guide = Vec3::UnitX();
    site = std::make_unique<Site>(settings, rig.world, *device);
    site->share(rig.addCube(0.2, kHalf));
    site->connect(other, mesh.link(other), -handle.start_W);
  }
  void tick(double now, int count) {
    mesh.poll(now);
    site->tick(now);
    if (count % kTicksPerHostStep == 0) rig.step(kPeriod * kTicksPerHostStep);
  }

  test::BulletRig rig;
  UdpMesh& mesh;
  PeerId other;
  std::unique_ptr<SimulatedDevice> device;
  std::unique_ptr<Site> site;
};

struct Felt {
  std::array<double, 2> force{};  ///< mean norm at each user [N]
  double apart = 0.0;             ///< mean distance of the copies [m]
};

/// Polls until both are live. Returns the time then [s].
double connect(UdpMesh& first, UdpMesh& second) {
  double now = 0.0;
  const auto is_live = [&](UdpMesh& mesh, std::uint32_t other) {
    return mesh.status(PeerId{other}, now).phase == PeerPhase::kLive;
  };
  for (; now < 10.0 && !(is_live(first, 2) && is_live(second, 1)); now += kPeriod) {
    first.poll(now);
    second.poll(now);
  }
  EXPECT_TRUE(is_live(first, 2) && is_live(second, 1));
  return now;
}

Felt feel(UdpMesh& first, UdpMesh& second) {
  const double begin = connect(first, second);
  User one(1, first), two(2, second);
  Felt felt;
  const int ticks = static_cast<int>(kDuration / kPeriod);
  for (int i = 1; i <= ticks; ++i) {
    const double now = begin + i * kPeriod;
    one.tick(now, i);
    two.tick(now, i);
    felt.force[0] += one.site->force().norm() / ticks;
    felt.force[1] += two.site->force().norm() / ticks;
    felt.apart += (one.site->object(0).p_W - two.site->object(0).p_W).norm() / ticks;
  }
  return felt;
}

Felt feelByUdp() {
  UdpMeshSettings settings;
  settings.bind = resolveAddress("127.0.0.1:0");
  UdpMesh second = makeMesh(2, settings);
  UdpMesh first = makeMesh(1, settings, second.bound());
  return feel(first, second);
}

Felt feelByDds() {
  test::DdsPair bus;
  PromptCarrier at_first(bus.first), at_second(bus.second);
  at_first.other = &at_second;
  at_second.other = &at_first;
  UdpMeshSettings settings;
  settings.carrier = &at_second;
  UdpMesh second = makeMesh(2, settings);
  settings.carrier = &at_first;
  UdpMesh first = makeMesh(1, settings);
  return feel(first, second);
}

TEST(DdsFeel, IsThatOfUdp) {
  const Felt udp = feelByUdp(), dds = feelByDds();
  EXPECT_GT(udp.force[0], 1.0);
  EXPECT_GT(udp.apart, 1e-4);
  EXPECT_NEAR(dds.force[0], udp.force[0], 0.01 * udp.force[0]);
  EXPECT_NEAR(dds.force[1], udp.force[1], 0.01 * udp.force[1]);
  EXPECT_NEAR(dds.apart, udp.apart, 0.01 * udp.apart);
}

}  // namespace
}  // namespace tandem
