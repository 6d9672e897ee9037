#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "bridge/bullet_rig.h"
#include "c_door/c_door_rig.h"

namespace tandem::test {

inline const double kNan = std::nan("");

/// A scene with every object that refusals concern.
struct Scene : LoneDoorProxy {
  TandemBody cube = TANDEM_NO_BODY, wall = TANDEM_NO_BODY;
  TandemWorld* bare = makeWorld();
  TandemDevice* spare = nullptr;
  TandemLink* loose = nullptr;
  BulletRig rig;
  TandemWorld* hosts = nullptr;

  Scene() : LoneDoorProxy(makeWorld()) {
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

  /// All readable values, as numbers.
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

/// A value that another language may pass: no C++ enumeration may hold such a number.
template <typename Enumeration>
void setNumber(Enumeration& enumeration, int number) {
  static_assert(sizeof enumeration == sizeof number);
  std::memcpy(&enumeration, &number, sizeof number);
}

/// A value that no function may overwrite.
template <typename Handle>
Handle* untouched() {
  static int place = 0;
  return reinterpret_cast<Handle*>(&place);
}

class Refused : public ::testing::TestWithParam<Case> {};

[[nodiscard]] inline std::string nameOf(const ::testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

}  // namespace tandem::test
