#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "plugin_host.h"

namespace tandem::test {

inline const char* const kFarHand = "device kind=moved start=10,0,0";

// Indices in the answer of `read`.
inline constexpr std::size_t kStatus = 10, kHasEnded = 15, kObjects = 18;

/// m x'' + B x' + K x = 0 from x0 at rest. K = 2000, B = 10, m = 0.1: w0 = 141/s, damping ratio
/// 0.35.
inline double computeRinging(double x0, double t) {
  const double c = 10.0 / 0.2, w = std::sqrt(2000.0 / 0.1 - c * c);
  return x0 * std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
}

/// A packet of user 2, whose hand rests at `hand`, with these objects at rest.
inline std::vector<double> makePacket(const Vec3& hand, const std::vector<Vec3>& objects = {}) {
  const double none = std::nan("");  // no account of energy
  std::vector<double> packet{2,
                             0,
                             0,
                             0,
                             hand.x(),
                             hand.y(),
                             hand.z(),
                             0,
                             0,
                             0,
                             none,
                             none,
                             static_cast<double>(objects.size())};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Vec3& p = objects[i];
    packet.insert(packet.end(), {static_cast<double>(i), p.x(), p.y(), p.z(), 0, 0, 0, 1, 0, 0, 0,
                                 0, 0, 0, 0, 0});
  }
  return packet;
}

/// A server with a shared cube without a pull, and no hand near.
struct SharedCube {
  PluginHost host;
  int cube;

  explicit SharedCube(const StubBody& body = makeStubCube(), const std::string& words = "")
      : cube(host.engine.add(body)) {
    host.command(kFarHand);
    host.command("site coordination=0,0 " + words);
    host.command("share body=" + std::to_string(cube));
  }
  StubBody& body() { return host.engine.bodies.at(cube); }
};

/// A cube on a floor, and a hand above that may press it. The hand's damping is above K T/2 = 1 N
/// s/m. With less, the force held for each tick would let it bounce.
struct Pressed {
  PluginHost host;
  int cube, floor;

  Pressed() {
    StubBody body = makeStubCube();
    body.state.p_W.z() = 0.02;
    cube = host.engine.add(body);
    floor = host.engine.add(makeStubFloor());
    host.engine.gravity = Vec3(0, 0, -9.81);
    host.command("device kind=simulated start=0,0,0.05 damping=5");
    host.command("site peers=1");
    host.command("share body=" + std::to_string(cube));
  }
};

inline bool isSaid(PluginHost& host, const std::string& words) {
  return host.warnings().find(words) != std::string::npos;
}

/// Two shared cubes on a floor, which is an obstacle.
struct TwoShared : Pressed {
  int other;

  TwoShared() {
    StubBody body = makeStubCube();
    body.state.p_W = Vec3(0.2, 0.0, 0.02);
    other = host.engine.add(body);
    host.command("share body=" + std::to_string(other));
    host.command("obstacle body=" + std::to_string(floor));
    host.step(20);
  }
  StubBody& body(int number) { return host.engine.bodies.at(number); }
  std::uint32_t status() { return static_cast<std::uint32_t>(host.read()[kStatus]); }
};

}  // namespace tandem::test
