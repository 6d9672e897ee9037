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
#include "net/mesh.h"

/// \file
/// One cell of the condition matrix: two sites with real meshes on a bad network, in virtual time.
namespace tandem::test {

/// What one site has felt and done.
struct SiteReport {
  double largest_force = 0.0;       ///< [N]
  double largest_force_step = 0.0;  ///< from one tick to the next [N]
  double largest_excess = 0.0;      ///< age of what was taken in, beyond delay and wait [s]
  double first_new = -1.0;          ///< after the outage's end the first new state came in [s]
  double recovered = -1.0;          ///< and the link was live or rejoining [s]; -1: never
  double live_again = -1.0;         ///< the same, live
  double last_coupled = -1.0;       ///< before the end, it was live or rejoining [s]; -1: never
  double overdrawn = 0.0;           ///< energy that the hand got when none was left [J]
  double last_taken = 0.0;          ///< before the end the last state came in [s]
  PeerPhase phase = PeerPhase::kCalling;
  std::uint32_t status = kTickOk;
  SiteCounters counters;
  bool is_finite = true;
};

struct CellReport {
  double joined = -1.0;       ///< both sites were live [s]; -1: never
  double least_energy = 0.0;  ///< that both hands have put in [J]
  std::array<SiteReport, 2> sites;
  std::uint64_t hash = 0;  ///< of both sites
};

class MatrixScene {
 public:
  static constexpr double kPeriod = 1e-3;    // [s]
  static constexpr double kMaxForce = 9.0;   ///< of the devices [N]
  static constexpr double kPatience = 30.0;  ///< for the handshake [s]
  static constexpr double kRampIn = 0.5;     ///< [s]
  static constexpr double kGrace = 0.5;      ///< for what must happen after an outage [s]

  MatrixScene(const Condition& condition, std::uint64_t seed);
  ~MatrixScene();

  /// Runs it once.
  [[nodiscard]] CellReport run();

 private:
  /// One user: world, device, mesh and site.
  struct User {
    double clock_offset = 0.0;  ///< own clock - ours [s]
    BulletRig rig;
    std::unique_ptr<SimulatedDevice> device;
    std::unique_ptr<net::Mesh> mesh;
    std::unique_ptr<LinkWatch> link;
    std::unique_ptr<Site> site;
    Vec3 force_W = Vec3::Zero(), p_W = Vec3::Zero();  ///< since the last tick, and then
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
  double phase_ = 0.0;  ///< of the stroke in which the outage begins [s]
  MatrixNetwork network_;
  std::array<User, 2> users_;
  std::uint64_t ticks_ = 0;
  double now_ = 0.0;
  double begin_ = 1e9;  ///< of the first stroke; not known before both are live [s]
  double outage_end_ = 1e9, end_ = 1e9;
  double energy_ = 0.0;
  CellReport report_;
};

}  // namespace tandem::test
