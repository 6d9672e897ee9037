#pragma once

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tandem/coordination/types.h"
#include "tandem/tandem.h"

namespace tandem::test {

inline constexpr TandemDeviceLimits kAnyForce{std::numeric_limits<double>::infinity(),
                                              std::numeric_limits<double>::infinity()};
inline constexpr double kFarAway[3] = {10.0, 0.0, 0.0};
inline constexpr double kNothing[3] = {0.0, 0.0, 0.0};

/// Fails the test with the door's message.
inline void ok(TandemResult result) {
  EXPECT_EQ(result, TANDEM_OK) << tandem_result_name(result) << ": " << tandem_last_error();
}

/// Tolerances for the width of the door's Bullet.
[[nodiscard]] inline double byDoorWidth(double if_double, double if_float) {
  return tandem_scalar_bytes() == 8 ? if_double : if_float;
}
/// Rounds to the width in which Bullet counts time.
[[nodiscard]] inline double roundToDoor(double value) {
  return tandem_scalar_bytes() == 8 ? value : static_cast<double>(static_cast<float>(value));
}

/// m x'' + B x' + K x = 0 from x0 at rest. K = 2000, B = 10, m = 0.1: w0 = 141/s, damping ratio
/// 0.35.
[[nodiscard]] inline double computeRinging(double x0, double t) {
  const double c = 10.0 / 0.2, w = std::sqrt(2000.0 / 0.1 - c * c);
  return x0 * std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
}

[[nodiscard]] inline TandemState makeState(const Vec3& p, const Vec3& v = Vec3::Zero()) {
  return {{p.x(), p.y(), p.z()}, {0, 0, 0, 1}, {v.x(), v.y(), v.z()}, {0, 0, 0}};
}
[[nodiscard]] inline Vec3 toVec3(const double values[3]) {
  return {values[0], values[1], values[2]};
}

/// A site in a world, with all its parts. The caller makes the world.
struct DoorSite {
  TandemWorld* world;
  TandemDevice* device = nullptr;
  TandemLink* link = nullptr;
  TandemSite* site = nullptr;
  TandemBody proxy = TANDEM_NO_BODY;

  explicit DoorSite(TandemWorld* in, const TandemSiteSettings& settings) : world(in) {
    ok(tandem_device_create_moved(kFarAway, kAnyForce, &device));
    ok(tandem_link_create_manual(&link));
    ok(tandem_site_create(&settings, world, device, &site));
  }
  ~DoorSite() {
    ok(tandem_site_destroy(site));
    ok(tandem_world_destroy(world));
    ok(tandem_device_destroy(device));
    ok(tandem_link_destroy(link));
  }
  DoorSite(const DoorSite&) = delete;
  DoorSite& operator=(const DoorSite&) = delete;

  [[nodiscard]] TandemReading read() const {
    TandemReading reading{};
    ok(tandem_site_read(site, &reading, 0, nullptr, 0, nullptr, nullptr));
    return reading;
  }
  [[nodiscard]] TandemState object(std::size_t number = 0) const {
    std::array<TandemState, 8> objects{};
    ok(tandem_site_read(site, nullptr, objects.size(), objects.data(), 0, nullptr, nullptr));
    return objects.at(number);
  }
  [[nodiscard]] TandemState body(TandemBody of) const {
    TandemState state{};
    ok(tandem_world_get_states(world, 1, &of, &state));
    return state;
  }
};

[[nodiscard]] inline TandemWorld* makeWorld() {
  TandemWorld* world = nullptr;
  ok(tandem_world_create(&world));
  return world;
}

/// A proxy with its coupler only. It starts 10 mm from its user, who is at rest and sent one
/// packet.
struct LoneDoorProxy : DoorSite {
  explicit LoneDoorProxy(TandemWorld* in) : DoorSite(in, makeSettings()) {
    const double start[3] = {0.01, 0.0, 0.0};
    ok(tandem_site_connect(site, 2, link, start, &proxy));
    TandemPacket packet{};
    packet.sender = 2;
    packet.energy_granted = std::nan("");
    ok(tandem_link_push(link, &packet));
  }
  static TandemSiteSettings makeSettings() {
    TandemSiteSettings settings = tandem_default_site_settings();
    settings.coordination = {2000.0, 10.0};
    settings.link_loss = 0;  // one packet pulls for ever
    return settings;
  }
};

/// A shared cube without a pull, with no hand near.
struct FreeDoorCube : DoorSite {
  TandemBody cube = TANDEM_NO_BODY;

  explicit FreeDoorCube(TandemWorld* in, double mass = 0.2,
                        const TandemSiteSettings& settings = makeSettings())
      : DoorSite(in, settings) {
    TandemBodySettings body = tandem_default_body_settings();
    body.mass = mass;
    ok(tandem_world_add_body(world, &body, &cube));
    ok(tandem_site_share(site, cube, 0.0, nullptr));
  }
  static TandemSiteSettings makeSettings() {
    TandemSiteSettings settings = tandem_default_site_settings();
    settings.coordination = {0.0, 0.0};
    return settings;
  }
};

}  // namespace tandem::test
