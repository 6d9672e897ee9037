#include "bench/speed/speed_site.h"

namespace tandem::demos::bench {
namespace {

constexpr int kPeers = 2;
constexpr double kPacketRate = 128.0;  // [Hz]

SiteSettings makeSettings() {
  SiteSettings settings;
  settings.peers = kPeers;
  settings.haptic_rate = SpeedSite::kHapticRate;
  settings.host_step = 1.0 / SpeedSite::kHostRate;
  settings.proxy.mass = kSpeedMass;
  settings.tick_source = TickSource::kCaller;
  return settings;
}

}  // namespace

SpeedSite::SpeedSite(const SpeedScene& scene)
    : world_(scene, kPeers),
      device_(scene),
      link_(scene),
      site_(makeSettings(), world_.world(), device_) {
  for (btRigidBody* cube : world_.cubes()) site_.share(*cube);
  site_.connect(PeerId{2}, link_, remoteAt(scene, 0.0).p_W);
}

int SpeedSite::tickUntil(double end) {
  int count = 0;
  for (; now() < end - 1e-9; ++count) tick();
  return count;
}

std::optional<Arrival> SpeedSite::PathLink::receive(double from, double) noexcept {
  if (from * kPacketRate < static_cast<double>(packet_.sequence) - 1e-6) return std::nullopt;
  ++packet_.sequence;
  packet_.time = from;
  packet_.user = remoteAt(scene_, from);
  return Arrival{packet_, from};
}

}  // namespace tandem::demos::bench
