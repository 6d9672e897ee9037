#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "matrix/condition.h"
#include "matrix/link_watch.h"
#include "matrix/matrix_network.h"
#include "net/peer_group.h"
#include "support/metered_device.h"

/// \file
/// One cell of the condition matrix: two sites with real meshes on a bad network, in virtual time.
namespace tandem::test {

/// Measurements of one site.
struct SiteReport {
  double largest_force = 0.0;   ///< [N]
  double largest_rise = 0.0;    ///< largest rise of the force from tick to tick [N]
  double largest_excess = 0.0;  ///< largest age of a state at arrival, beyond delay and wait [s]
  double first_new = -1.0;      ///< time from the outage's end to the first new state [s]
  double recovered = -1.0;      ///< time from there until live or rejoining [s]; -1: never
  double live_again = -1.0;     ///< time from there until live [s]; -1: never
  double last_coupled = -1.0;   ///< time from last live or rejoining to the end [s]; -1: never
  double overdrawn = 0.0;       ///< energy that the hand got with an empty tank [J]
  double last_taken = 0.0;      ///< time from the last state to the end [s]
  PeerPhase phase = PeerPhase::kCalling;
  std::uint32_t status = kTickOk;
  SiteCounters counters;
  bool is_finite = true;
};

struct CellReport {
  double joined = -1.0;       ///< time at which both sites were live [s]; -1: never
  double least_energy = 0.0;  ///< least energy put in by both hands [J]
  std::array<SiteReport, 2> sites;
  std::uint64_t hash = 0;  ///< state hash of both sites
};

class MatrixScene {
 public:
  static constexpr double kPeriod = 1e-3;    // [s]
  static constexpr double kMaxForce = 9.0;   ///< force limit of the devices [N]
  static constexpr double kPatience = 30.0;  ///< limit for the handshake [s]
  static constexpr double kRampIn = 0.5;     ///< [s]
  static constexpr double kGrace = 0.5;      ///< limit for required reactions after an outage [s]

  MatrixScene(const Condition& condition, std::uint64_t seed);
  ~MatrixScene();

  /// Runs the cell once.
  [[nodiscard]] CellReport run();

 private:
  /// One user: world, device, mesh and site.
  struct User {
    double clock_offset = 0.0;  ///< own clock minus scene time [s]
    BulletRig rig;
    std::unique_ptr<SimulatedDevice> handle;
    std::unique_ptr<MeteredDevice> device;
    std::unique_ptr<net::PeerGroup> mesh;
    std::unique_ptr<LinkWatch> link;
    std::unique_ptr<Site> site;
    Vec3 force_W = Vec3::Zero();  ///< force of the last tick
    SiteReport report;
  };

  void makeUser(std::size_t i);
  [[nodiscard]] std::unique_ptr<Hand> makeHand(std::size_t i) const;
  [[nodiscard]] Vec3 startOf(std::size_t i) const;
  [[nodiscard]] PeerId idOf(std::size_t i) const {
    return PeerId{static_cast<std::uint32_t>(i) + 1};
  }
  void planFrom(double now);
  void step();
  void tickUser(std::size_t i);
  void watchLink(User& user);
  [[nodiscard]] bool areLive() const;
  [[nodiscard]] PeerStatus statusOf(std::size_t i) const;

  Condition c_;
  double phase_ = 0.0;  ///< start of the outage within its stroke [s]
  MatrixNetwork network_;
  std::array<User, 2> users_;
  std::uint64_t ticks_ = 0;
  double now_ = 0.0;
  double begin_ = 1e9;  ///< start of the first stroke; unknown before both are live [s]
  double outage_end_ = 1e9, end_ = 1e9;
  CellReport report_;
};

}  // namespace tandem::test
