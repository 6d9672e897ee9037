#pragma once

#include "bench/stress/stress_case.h"

namespace tandem::demos::bench {

/// Sampling makes a stiff contact active: a force held for a period T does the work of a spring
/// that is half a period late. Colgate & Schenkel (1994): a device with own damping b renders a
/// wall K, B passively if b > K T / 2 + B.
[[nodiscard]] bool isSampledContactPassive(double device_damping, const CouplerGains& wall,
                                           double period);

/// Longest delay [s] for which two equal masses, each tied to the delayed other by K, B, come to
/// rest. Roots cross the imaginary axis only at w^2 = 2 K / m. There the delay turns the phase by
/// twice that of the damper:
///
///   m s^2 + (B s + K)(1 + e^(-s tau)) = 0      tau = 2 atan(B w / K) / w
[[nodiscard]] double computeLongestDelay(const CouplerGains& coupler, double mass);

/// True if analysis shows that the case stays bounded by itself: no part of a closed loop is
/// active, with a factor of two in reserve. Scripted users close no loop. Loops with lost packets
/// or jitter are not analysed and give false.
[[nodiscard]] bool isAnalysedStable(const StressCase& one);

}  // namespace tandem::demos::bench
