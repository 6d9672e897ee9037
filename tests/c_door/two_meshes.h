#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include <unistd.h>

#include "c_door/c_door_rig.h"

namespace tandem::test {

inline constexpr double kPatience = 30.0;  // [s], for a loaded machine

/// Time of the process since its first use [s].
[[nodiscard]] inline double readClock() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Two meshes of this process over loopback; the first calls the second.
struct TwoMeshes {
  std::filesystem::path folder;
  std::string key;
  TandemMesh *first = nullptr, *second = nullptr;

  explicit TwoMeshes(const char* mass_there = "0.2") {
    static int count = 0;
    folder = std::filesystem::temp_directory_path() /
             ("tandem_c_door_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directory(folder);
    key = folder / "pair.key";
    ok(tandem_key_create(key.c_str()));
    std::uint16_t port = 0;
    const TandemAgreement here{"object.mass", "0.2"}, there{"object.mass", mass_there};
    const TandemMeshPeer caller{1, nullptr, key.c_str()};
    ok(tandem_mesh_create(2, "127.0.0.1:0", 1, &caller, 1, &there, &second));
    ok(tandem_mesh_port(second, &port));
    const std::string address = "127.0.0.1:" + std::to_string(port);
    const TandemMeshPeer called{2, address.c_str(), key.c_str()};
    ok(tandem_mesh_create(1, "127.0.0.1:0", 1, &called, 1, &here, &first));
  }
  ~TwoMeshes() {
    ok(tandem_mesh_destroy(first));
    ok(tandem_mesh_destroy(second));
    std::filesystem::remove_all(folder);
  }
  TwoMeshes(const TwoMeshes&) = delete;
  TwoMeshes& operator=(const TwoMeshes&) = delete;

  void poll() const {
    ok(tandem_mesh_poll(first, readClock()));
    ok(tandem_mesh_poll(second, readClock()));
  }
  [[nodiscard]] TandemPeerPhase phase(const TandemMesh* mesh, std::uint32_t peer) const {
    TandemPeerStatus status{};
    ok(tandem_mesh_status(mesh, peer, readClock(), &status));
    return status.phase;
  }
  [[nodiscard]] bool areBoth(TandemPeerPhase wanted) const {
    return phase(first, 2) == wanted && phase(second, 1) == wanted;
  }
  template <typename Done>
  [[nodiscard]] bool pollUntil(Done done) const {
    const double end = readClock() + kPatience;
    while (readClock() < end && !done()) {
      poll();
      usleep(500);
    }
    return done();
  }
};

/// A site of its own world with a shared cube, on a link that it does not own.
struct LinkedSite {
  TandemWorld* world = makeWorld();
  TandemDevice* device = nullptr;
  TandemSite* site = nullptr;
  TandemBody cube = TANDEM_NO_BODY;

  LinkedSite(std::uint32_t self, TandemLink* link,
             TandemTickSource source = TANDEM_TICK_HOST_STEP) {
    TandemSiteSettings settings = tandem_default_site_settings();
    settings.self = self;
    settings.tick_source = source;
    const TandemBodySettings body = tandem_default_body_settings();
    ok(tandem_world_add_body(world, &body, &cube));
    ok(tandem_device_create_moved(kFarAway, kAnyForce, &device));
    ok(tandem_site_create(&settings, world, device, &site));
    ok(tandem_site_share(site, cube, 0.0, nullptr));
    ok(tandem_site_connect(site, 3 - self, link, kFarAway, nullptr));
  }
  ~LinkedSite() {
    ok(tandem_site_destroy(site));
    ok(tandem_world_destroy(world));
    ok(tandem_device_destroy(device));
  }
  LinkedSite(const LinkedSite&) = delete;
  LinkedSite& operator=(const LinkedSite&) = delete;

  [[nodiscard]] TandemReading read(TandemState* object = nullptr) const {
    TandemReading reading{};
    ok(tandem_site_read(site, &reading, object ? 1 : 0, object, 0, nullptr, nullptr));
    return reading;
  }
};

/// Compares two copies, of which the second began at the origin. They have met if it has moved and
/// both are at one place. The place depends on the delays.
struct Meeting {
  TandemState here{}, there{};
  bool has_moved = false;

  [[nodiscard]] bool look(const LinkedSite& one, const LinkedSite& two) {
    (void)one.read(&here), (void)two.read(&there);
    has_moved |= std::abs(there.position[1]) > 1e-3;
    return has_moved && std::abs(here.position[1] - there.position[1]) < 1e-4;
  }
};

}  // namespace tandem::test
