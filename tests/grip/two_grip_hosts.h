#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <tuple>
#include <utility>

#include "tandem/coordination/simulated_link.h"

#include "grip/grip_rig.h"

namespace tandem::test {

/// Two hosts with a copy of one body each, and a hand at each.
struct TwoGripHosts {
  std::array<std::unique_ptr<GripHost>, 2> hosts;
  std::array<std::unique_ptr<SimulatedLink>, 2> links;

  TwoGripHosts(ScriptedDevice::Path first, ScriptedDevice::Path second) {
    hosts[0] = std::make_unique<GripHost>(std::move(first));
    hosts[1] = std::make_unique<GripHost>(std::move(second));
    for (std::uint32_t i = 0; i < 2; ++i) {
      hosts[i]->settings.self = PeerId{i + 1};
      hosts[i]->settings.peers = 2;
    }
  }
  void start(const Impairments& network, double mass, const Vec3& half) {
    std::tie(links[0], links[1]) = makeSimulatedLinks(network, 4096);
    for (std::uint32_t i = 0; i < 2; ++i) hosts[i]->start(mass, half);
    for (std::uint32_t i = 0; i < 2; ++i)
      hosts[i]->site->connect(PeerId{2 - i}, *links[i], hosts[1 - i]->device.at(0.0));
  }
  /// Steps both; `look` sees each step.
  void run(
      double duration, const std::function<void()>& look = [] {}) {
    for (const double end = now() + duration; now() < end - 1e-9; look())
      for (auto& host : hosts) host->run(kHostStep);
  }
  /// Packets under way get lost.
  void dropAll() {
    for (auto& link : links)
      while (link->receive(now() + 1.0, now() + 1.0)) {
      }
  }
  [[nodiscard]] double now() const { return hosts[0]->now; }
  [[nodiscard]] Site& site(int i) { return *hosts[i]->site; }
  [[nodiscard]] const RigidState& object(int i) const { return hosts[i]->site->object(0); }
};

}  // namespace tandem::test
