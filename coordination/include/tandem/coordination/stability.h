#pragma once

#include <array>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/coupling_settings.h"
#include "tandem/coordination/types.h"

/// \file
/// Linear stability of a networked cooperation, with all contacts closed. It is the tick of a site
/// as it is: device sampled and held, packets at their moments, exact maps between. Nothing is
/// approximated but that contact stays closed, along one axis.
#pragma GCC visibility push(default)
namespace tandem {

/// How a remote user is felt.
enum class StandInKind {
  kNone,     ///< through shared objects only: virtual_coupling
  kHeld,     ///< as a body at the delayed state: kinematic_proxy
  kDynamic,  ///< as a body that is driven there: remote_dynamic_proxy
};

/// A hand that holds its device, or the hand of nobody.
struct HandImpedance {
  double mass = 0.0;       ///< that moves with the device [kg]
  double stiffness = 0.0;  ///< [N/m]
  double damping = 0.0;    ///< [N s/m]
};

/// A cooperation of equal users along one axis.
struct LoopSettings {
  StandInKind stand_in = StandInKind::kDynamic;
  int users = 2;  ///< N, 2 or more
  CoordinationMode mode = CoordinationMode::kSum;
  std::optional<double> stand_in_share;    ///< of a whole user; empty: as sites have it
  bool has_object = true;                  ///< users touch a shared object; false: each other
  double object_mass = 0.2;                ///< m, of the whole [kg]
  double object_damping = 0.0;             ///< b, of each copy [N s/m]
  CouplerGains contact{4000.0, 1.0};       ///< K_vc, B_vc
  CouplerGains coordination{200.0, 30.0};  ///< K_t, B_t
  double proxy_mass = 0.1;                 ///< m_h [kg]
  double proxy_damping = 0.0;              ///< b_h [N s/m]
  double device_mass = 0.1;                ///< [kg]
  double device_damping = 0.5;             ///< b_dev [N s/m]
  HandImpedance hand;
  double haptic_rate = 1000.0;  ///< [Hz]
  double packet_rate = 128.0;   ///< [Hz]
  double delay = 0.05;          ///< T_d, one way [s], at most kLongestDelay
};

/// Longest delay that is analysed [s]: packets on their way are states.
inline constexpr double kLongestDelay = 0.5;

/// A pattern of motion of equal users.
enum class MotionMode {
  kCommon,      ///< all together
  kDifference,  ///< against each other
  kDeaf,        ///< one user, whom the others do not answer yet
};

/// All, in the order of their values. The first two go on; kDeaf ends with an answer.
inline constexpr std::array<MotionMode, 3> kMotionModes = {
    MotionMode::kCommon, MotionMode::kDifference, MotionMode::kDeaf};

[[nodiscard]] const char* name(MotionMode mode) noexcept;

/// How a small motion goes on.
struct Growth {
  double rate = 0.0;       ///< of its size [1/s]; below 0: it dies out
  double frequency = 0.0;  ///< [Hz]
};

/// Growth of the fastest growing motion of a mode. Throws std::invalid_argument that names a
/// setting out of range.
[[nodiscard]] Growth computeGrowth(const LoopSettings& settings, MotionMode mode);

/// The same for its rate alone, in a third of the time.
[[nodiscard]] double computeGrowthRate(const LoopSettings& settings, MotionMode mode);

/// Growth rate of the fastest motion if the packets of all users but the first leave a part of a
/// packet period later, 0 to 1. Clocks of live sites drift through all phases. Takes N^3 times as
/// long as a mode.
[[nodiscard]] double computeRateAtPhase(const LoopSettings& settings, double phase);

/// Force that each user needs for each m/s while all move on together, in [N s/m]: the delay's
/// drag, and that of devices, copies and proxies. Throws as computeGrowth() does, and for a hand
/// with stiffness, which lets nothing move on.
[[nodiscard]] double computeDrag(const LoopSettings& settings);

/// All multipliers of a mode over one period of its packets and ticks, largest first.
[[nodiscard]] std::vector<std::complex<double>> computeMultipliers(const LoopSettings& settings,
                                                                   MotionMode mode);

}  // namespace tandem
#pragma GCC visibility pop
