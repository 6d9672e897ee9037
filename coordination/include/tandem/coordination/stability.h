#pragma once

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

/// A hand that holds its device, as people do who do not push.
inline constexpr HandImpedance kHeldHand{0.0, 300.0, 5.0};

/// How a user differs from what LoopSettings says of all: factors, 0 or more.
struct LoopUser {
  double device_mass = 1.0;  ///< above 0
  double device_damping = 1.0;
  double contact_stiffness = 1.0, contact_damping = 1.0;  ///< of all contacts at this site
  /// To each user, by number, 0 to 1; the own one is unused. Empty: all 1.
  std::vector<double> delays;
};

/// Most users that may differ: all of them are analysed together.
inline constexpr int kMostUnlikeUsers = 4;

/// A cooperation along one axis.
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
  std::vector<LoopUser> each;   ///< one for each user; empty: all are alike

  [[nodiscard]] bool areUsersAlike() const noexcept { return each.empty(); }
};

/// Longest delay that is analysed [s]: packets on their way are states.
inline constexpr double kLongestDelay = 0.5;

/// A pattern of motion.
enum class MotionMode {
  kCommon,      ///< all together, of users who are alike
  kDifference,  ///< against each other, of users who are alike
  kAny,         ///< any motion, of users who differ
  kDeaf,        ///< one user, whom the others do not answer yet
};

/// All that a cooperation has. kDeaf is the last: it ends with an answer, the others go on.
[[nodiscard]] std::vector<MotionMode> listModes(const LoopSettings& settings);
/// The same without kDeaf.
[[nodiscard]] std::vector<MotionMode> listLastingModes(const LoopSettings& settings);

[[nodiscard]] const char* name(MotionMode mode) noexcept;

/// How a small motion goes on.
struct Growth {
  double rate = 0.0;       ///< of its size [1/s]; below 0: it dies out
  double frequency = 0.0;  ///< [Hz]
  /// Speed of each user's device, over the fastest one's; below 0: against it. Empty if users are
  /// alike.
  std::vector<double> shares;
};

/// Growth of the fastest growing motion of a mode that the cooperation has. Throws
/// std::invalid_argument that names a setting out of range.
[[nodiscard]] Growth computeGrowth(const LoopSettings& settings, MotionMode mode);

/// The same for its rate alone, in a third of the time.
[[nodiscard]] double computeGrowthRate(const LoopSettings& settings, MotionMode mode);

/// Growth rate of the fastest motion if the packets of all users but the first leave a part of a
/// packet period later, 0 to 1. Clocks of live sites drift through all phases. Takes N^3 times as
/// long as a mode.
[[nodiscard]] double computeRateAtPhase(const LoopSettings& settings, double phase);

/// Force that each user needs for each m/s while all move on together, in [N s/m], a mean of users
/// who differ: the delay's drag, and that of devices, copies and proxies. Throws as computeGrowth()
/// does, and for a hand with stiffness, which lets nothing move on.
[[nodiscard]] double computeDrag(const LoopSettings& settings);

/// The packet rate that is analysed [Hz]: ticks and packets meet again within 2000 ticks. Others
/// are rounded, mostly by 1e-6 to 1e-4 of them, at most by 1e-3. Throws as computeGrowth() does.
[[nodiscard]] double findAnalysedPacketRate(const LoopSettings& settings);

/// All multipliers of a mode over one period of its packets and ticks, largest first.
[[nodiscard]] std::vector<std::complex<double>> computeMultipliers(const LoopSettings& settings,
                                                                   MotionMode mode);

}  // namespace tandem
#pragma GCC visibility pop
