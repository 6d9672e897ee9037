#pragma once

#include <optional>

#include "tandem/coordination/coupling_settings.h"
#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

class Scheme;

/// How forces reach the host's bodies.
enum class Injection {
  kHandoff,  ///< the island moves its bodies exactly; Bullet gets their average velocity at any
             ///< host rate
  kImpulse,  ///< Bullet moves them under impulses F dt; the host must step at the haptic rate
};

/// Who carries contact and coupling. All but the first are what Bullet itself offers, for
/// comparison: no island, so everything has the host's rate, and docs/native.md says what else.
enum class ContactModel {
  kIsland,        ///< the island: the plugin's own laws at the haptic rate
  kNativeRigid,   ///< Bullet's rigid contact; couplers by impulses in the pre-tick
  kNativeSoft,    ///< Bullet's contact stiffness and damping; couplers by impulses
  kSpring6Dof,    ///< soft contact; couplers by btGeneric6DofSpring2Constraint
  kPointToPoint,  ///< soft contact; couplers by btPoint2PointConstraint
};

/// Who calls Site::tick().
enum class TickSource {
  kHostStep,  ///< the site itself, from the host's stepSimulation(): nothing else to do for the
              ///< host
  kCaller,    ///< whoever made the site: virtual time with several sites, or a haptic thread
};

/// All numbers of a site. Checked by Site's constructor.
struct SiteSettings {
  PeerId self{1};
  int peers = 2;                ///< N: every shared object is carried by N copies of mass m/N
  double haptic_rate = 1000.0;  ///< device loop [Hz]; higher renders stiffer contact
  double packet_rate = 128.0;   ///< states sent per second [Hz], at most the haptic rate
  /// While nothing moves or touches for half a second, states go out at 1 / kIdlePacketPeriod, and
  /// say so; the first motion is sent in its tick. False: always at `packet_rate`.
  bool thins_when_idle = true;
  double host_step = 0.0;             ///< expected first step of the host [s]; 0: learnt from it
  CouplerGains contact{4000.0, 1.0};  ///< K_vc, B_vc of every contact of spheres
  CouplerGains coordination{200.0,
                            30.0};  ///< K_t, B_t: proxies to users, object copies to each other
  /// Turns object copies towards each other [N m/rad, N m s/rad]. Nothing: K_t J/m and B_t J/m, as
  /// if each bit of mass were tied to its own copy.
  std::optional<CouplerGains> angular_coordination;
  ProxySettings proxy;             ///< m_h, b_h and size of what stands for a remote user
  double hip_radius = 0.01;        ///< sphere of the local haptic interface point [m]
  const Scheme* scheme = nullptr;  ///< null: remote_dynamic_proxy
  ContactModel contact_model = ContactModel::kIsland;
  Injection injection = Injection::kHandoff;  ///< of the island; native models know hand-off only
  TickSource tick_source = TickSource::kHostStep;
  std::optional<Vec3> guide;  ///< unit vector in W: a slot that leaves bodies this direction only
  double inner_step = 1.0 / 4000.0;  ///< where motion is not linear [s]; smaller is more exact
  /// Moving bodies of the host that the island may hold at a time, nearest first; 0: all stay
  /// Bullet's.
  int max_neighbours = 16;
  double host_stall = 0.0;  ///< time for which the host may be silent [s]; wider search if larger
  /// What is done when a remote peer falls silent. With a native contact model gains change once
  /// per host step, and rigid contact, which has none, ends when the proxy is lost.
  LinkLossSettings link_loss;
  /// What the hand may get out of the connection, with hand-off and an account at all sites.
  PassivitySettings passivity;
  double max_slew = 1e4;       ///< change of the force at the device [N/s]; may be infinite
  double fault_slew = 2000.0;  ///< after a fault the force fades by this [N/s]
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkSiteSettings(const SiteSettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
