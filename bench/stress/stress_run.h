#pragma once

#include <cstdint>

#include "bench/account/energy_account.h"
#include "bench/stress/stress_case.h"

namespace tandem::demos::bench {

/// Part of the largest energy by which an account may be off.
inline constexpr double kEnergyTolerance = 1e-6;
/// The same for bodies in joints.
inline constexpr double kJoinedTolerance = 1e-4;
/// The same for rigid contact, which is of second order in steps as long as a haptic period.
inline constexpr double kRigidTolerance = 2e-4;
/// The same where a tick had too much rigid contact to solve to the end.
inline constexpr double kBoundedTolerance = 2e-2;
/// A closed loop with so many times the energy input explodes.
inline constexpr double kMostGrowth = 10.0;

/// Outcome of a case. A plain value, so that a worker process can pass it as bytes.
struct StressOutcome {
  std::uint64_t index = 0;
  std::int32_t kind = 0;
  bool finite = true;             ///< state, force and Bullet's bodies are finite
  bool is_stable = false;         ///< stable by its own analysis (stress_stability.h)
  bool was_cut = false;           ///< ended early, after kMostWork
  bool refused = false;           ///< the site refused the settings
  bool crashed = false;           ///< the process that ran it crashed
  double simulated = 0.0;         ///< [s]
  double peak = 0.0;              ///< largest energy that took part [J]
  double unaccounted = 0.0;       ///< part of the peak by which the account is off
  double unaccounted_time = 0.0;  ///< [s]
  double jump = 0.0;              ///< way beyond the speed limit [m]
  double jump_time = 0.0;         ///< [s]
  double growth = 0.0;            ///< closed loop: largest energy over energy input [1]
  double deviation = 0.0;     ///< paper's case: distance to the reference over the largest way [1]
  double host_contact = 0.0;  ///< spring energy that appeared in a host step, as part of the peak
  double pin_gap = 0.0;       ///< largest distance of a joint's two points in the host's world [m]
  double work_in = 0.0;       ///< work of hands and targets [J]
  double start_energy = 0.0, end_energy = 0.0;  ///< [J]
  double seconds = 0.0;                         ///< run time [s]
  std::uint64_t steps = 0;                      ///< steps of the integrators

  /// Part of the largest energy by which the account may be off: kEnergyTolerance plus known errors
  /// (docs/benchmarks.md).
  double allowed = kEnergyTolerance;

  /// True if a host step found a body only after a sphere had entered it.
  [[nodiscard]] bool isLate() const { return host_contact > kEnergyTolerance; }
  [[nodiscard]] bool isStrict() const { return allowed < 2.0 * kEnergyTolerance; }
};

/// Runs a case. `traces`, if given, gets the account of each of its islands, look by look.
[[nodiscard]] StressOutcome runStressCase(const StressCase& one,
                                          std::vector<std::vector<AccountRow>>* traces = nullptr);

}  // namespace tandem::demos::bench
