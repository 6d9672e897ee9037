#include "stability/drawn/drawn_loops.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace tandem::test {
namespace {

/// Multiples of 10 Hz: ticks and packets meet again within 0.1 s.
double drawRate(Random& random, double least, double most) {
  return 10.0 * std::round(0.1 * random.logUniform(least, most));
}

}  // namespace

LoopSettings drawLoop(Random& random) {
  LoopSettings s;
  constexpr std::array kKinds = {StandInKind::kNone, StandInKind::kHeld, StandInKind::kDynamic};
  const int scheme = random.below(5);
  s.stand_in = kKinds[static_cast<std::size_t>(scheme < 3 ? scheme : scheme - 2)];
  s.has_object = scheme < 3;
  constexpr std::array kUsers = {2, 3, 4, 8};
  const int users = kUsers[static_cast<std::size_t>(random.below(4))];
  if (s.has_object) s.users = users;
  s.mode = random.below(2) == 0 ? CoordinationMode::kSum : CoordinationMode::kAverage;
  s.haptic_rate = drawRate(random, 60.0, 1000.0);
  s.packet_rate = drawRate(random, 60.0, s.haptic_rate);
  s.delay = random.uniform(0.0, 0.3);
  s.device_mass = random.logUniform(0.05, 0.3);
  s.device_damping = random.logUniform(0.2, 10.0);
  s.contact.damping = random.logUniform(0.5, 8.0);
  // Of the stiffness that a sampled wall allows.
  const double wall = 2.0 * (s.contact.damping + s.device_damping) * s.haptic_rate;
  s.contact.stiffness = std::clamp(random.logUniform(0.02, 1.0) * wall, 20.0, 8000.0);
  s.coordination = {random.logUniform(20.0, 1000.0), random.logUniform(2.0, 60.0)};
  s.object_mass = s.users * random.logUniform(0.05, 0.3);
  s.object_damping = random.uniform(0.0, 0.5);
  s.proxy_mass = random.logUniform(0.05, 0.3);
  s.proxy_damping = random.uniform(0.0, 0.5);
  if (random.below(2) == 0) s.hand = {0.0, 300.0, 5.0};
  return s;
}

std::string describe(const LoopSettings& s) {
  const char* scheme = s.stand_in == StandInKind::kNone   ? "VC"
                       : s.stand_in == StandInKind::kHeld ? "kinematic"
                                                          : "RDP";
  return fmt::format("{} {} {} {} {:g}/{:g} Hz {:.1f} ms {}", scheme,
                     s.has_object ? "cube" : "contact", s.users,
                     s.mode == CoordinationMode::kSum ? "sum" : "average", s.haptic_rate,
                     s.packet_rate, 1e3 * s.delay, s.hand.stiffness > 0.0 ? "held" : "free");
}

std::string describeGains(const LoopSettings& s) {
  return fmt::format(
      "K_t {:.6g} B_t {:.6g} K_vc {:.6g} B_vc {:.6g} b_dev {:.6g} m_dev {:.6g} m {:.6g} b {:.6g} "
      "m_h {:.6g} b_h {:.6g}",
      s.coordination.stiffness, s.coordination.damping, s.contact.stiffness, s.contact.damping,
      s.device_damping, s.device_mass, s.object_mass, s.object_damping, s.proxy_mass,
      s.proxy_damping);
}

}  // namespace tandem::test
