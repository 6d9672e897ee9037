#include "bench/speed/speed_site.h"

namespace tandem::demos::bench {
namespace {

constexpr double kPacketRate = 128.0;  // [Hz]

SiteSettings makeSettings(const SpeedScene& scene) {
  SiteSettings settings;
  settings.peers = scene.users;
  if (scene.users > 2) settings.coordination_mode = CoordinationMode::kAverage;
  settings.haptic_rate = SpeedSite::kHapticRate;
  settings.host_step = 1.0 / SpeedSite::kHostRate;
  settings.proxy.mass = kSpeedMass;
  settings.tick_source = TickSource::kCaller;
  return settings;
}

}  // namespace

SpeedSite::SpeedSite(const SpeedScene& scene)
    : world_(scene, scene.users),
      device_(scene),
      site_(makeSettings(scene), world_.world(), device_) {
  for (btRigidBody* cube : world_.cubes()) site_.share(*cube);
  for (int place = 0; place < scene.users - 1; ++place) {
    PathLink& link = links_.emplace_back(scene, place);
    site_.connect(link.id(), link, link.findUser(0.0).p_W);
  }
}

PointState SpeedSite::PathLink::findUser(double now) const {
  constexpr double kApart = 0.03;  // [m]
  PointState user = remoteAt(scene_, now);
  user.p_W.y() += kApart * place_;
  return user;
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
  packet_.user = findUser(from);
  return Arrival{packet_, from};
}

}  // namespace tandem::demos::bench
