#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "tandem/coordination/coupling_settings.h"
#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

class Scheme;

/// Way in which forces reach the host's bodies.
enum class Injection {
  kHandoff,  ///< the island moves its bodies exactly; Bullet gets average velocities, at any rate
  kImpulse,  ///< Bullet moves bodies under impulses F dt; the host steps at the haptic rate
};

/// Model of contact and coupling. All but the first use Bullet's own means, for comparison. They
/// have no island, so everything runs at the host's rate; see docs/native.md.
enum class ContactModel {
  kIsland,        ///< the plugin's own laws in the island, at the haptic rate
  kNativeRigid,   ///< Bullet's rigid contact; couplers are impulses in the pre-tick
  kNativeSoft,    ///< Bullet's contact stiffness and damping; couplers are impulses
  kSpring6Dof,    ///< soft contact; couplers are btGeneric6DofSpring2Constraint
  kPointToPoint,  ///< soft contact; couplers are btPoint2PointConstraint
};

/// Caller of Site::tick().
enum class TickSource {
  kHostStep,  ///< the site itself, from the host's stepSimulation()
  kCaller,    ///< the owner of the site: virtual time with several sites, or a haptic thread
};

/// A grip: a spring-damper of six degrees of freedom between a hand and a place on a shared object.
///
///   f = K (p_hand - p_grip) + B (v_hand - v_grip) + lift      on the object, -f on the hand
///   t = K r^2 theta - B_r w                                   towards the orientation of the grab
///
/// The limit belongs to the grip: the device's own limits clip only what is felt.
struct GripSettings {
  double stiffness = 2000.0;   ///< K [N/m]; higher holds closer and needs a faster haptic rate
  double damping_ratio = 1.0;  ///< of B with hand and copy, of B_r with the copy; higher: calmer
  double radius = 0.03;        ///< r of the torque's spring [m]; larger turns less
  double max_force = 40.0;     ///< [N]; times r: limit of the torque [N m]
  double lift_time = 0.25;     ///< within which the hand takes over a weight [s]; 0: objects sag
  double blend_time = 0.1;     ///< within which an object comes to the hand that grabs it [s]
  double break_time = 0.1;     ///< at the force's limit, after which the grip breaks [s]
  double fade_time = 0.05;     ///< of the force after a release or break [s]
};

/// The hold of a tool: the law of a grip, softer and without an end. Its times are the grip's.
struct ToolSettings {
  double stiffness = 1500.0;   ///< K [N/m]; higher is stiffer and needs a faster haptic rate
  double damping_ratio = 0.7;  ///< of B with hand and tool, of B_r with the tool; higher: calmer
  double radius = 0.025;       ///< r of the torque's spring [m]; larger turns less
  double max_force = 40.0;     ///< [N]; times r: limit of the torque [N m]
};

/// How the number N of sites follows who is there.
struct MembershipSettings {
  /// N counts the sites that all of them hear; each begins alone. False: N is SiteSettings::peers,
  /// also while somebody is silent. Needs the island, hand-off and LinkLossSettings::enabled.
  bool follows = false;
  double leave_after = 30.0;  ///< silence after which a peer that said no farewell has left [s]
};

/// Settings of a site. Site's constructor checks them.
struct SiteSettings {
  PeerId self{1};
  int peers = 2;                ///< N: a shared object has N copies of mass m/N; see `membership`
  double haptic_rate = 1000.0;  ///< device loop [Hz]; higher renders stiffer contact
  double packet_rate = 128.0;   ///< states sent per second [Hz], at most the haptic rate
  /// Sent to all peers together, with IP headers and as `float32` [bit/s]; 0: no limit. If it is
  /// too small for all packets, peers whose hands are far get rare ones. Near peers still get all,
  /// so they may exceed it.
  double packet_budget = 0.0;
  /// If nothing moves or touches for half a second, states go out once per kIdlePacketPeriod and
  /// are marked idle. The first motion is sent in its tick. False: always at `packet_rate`.
  bool thins_when_idle = true;
  double host_step = 0.0;             ///< first step expected of the host [s]; 0: learnt from it
  CouplerGains contact{4000.0, 1.0};  ///< K_vc, B_vc of every contact coupling of spheres
  CouplerGains coordination{200.0, 30.0};  ///< K_t, B_t: proxy to user, object copy to object copy
  CoordinationMode coordination_mode = CoordinationMode::kSum;  ///< kAverage for N above 2
  /// Rotational coupling of object copies [N m/rad, N m s/rad]. Empty: K_t J/m and B_t J/m, as if
  /// each mass element were coupled to its own copy.
  std::optional<CouplerGains> angular_coordination;
  ProxySettings proxy;       ///< m_h, b_h and size of the proxy of a remote user
  double hip_radius = 0.01;  ///< sphere of the local haptic interface point [m]
  /// Collision group and mask of the hand and of remote users' proxies, as bodies of Bullet have
  /// them. The defaults meet all bodies of Bullet's default groups. Native models ignore both.
  int hand_group = 1, hand_mask = -1;
  /// With nothing shared and nobody connected the hand feels moving bodies too, and the island
  /// holds those near it. False: only fixed ones, and the host's simulation stays the same to the
  /// bit.
  bool hand_feels_moving_bodies = true;
  const Scheme* scheme = nullptr;  ///< null: remote_dynamic_proxy
  ContactModel contact_model = ContactModel::kIsland;
  Injection injection = Injection::kHandoff;  ///< for the island; native models only hand off
  TickSource tick_source = TickSource::kHostStep;
  std::optional<Vec3> guide;         ///< unit vector in W: bodies may only move along it
  double inner_step = 1.0 / 4000.0;  ///< step of non-linear motion [s]; smaller is more exact
  /// Most moving host bodies that the island holds at a time, nearest first. 0: all stay in Bullet.
  int max_neighbours = 16;
  double host_stall = 0.0;  ///< longest expected silence of the host [s]; widens the search
  GripSettings grip;        ///< Site::grab()
  ToolSettings tool;        ///< Site::shareTool()
  /// Reaction to a silent remote peer. With a native contact model gains change once per host step.
  /// Rigid contact has no gain; it ends when the proxy is lost.
  LinkLossSettings link_loss;
  MembershipSettings membership;
  /// Limit of the energy that the hand gets from the connection. Needs hand-off and an account at
  /// all sites.
  PassivitySettings passivity;
  /// A peer's host that puts a shared object elsewhere takes our copy along at once. False: it is
  /// led there in about two seconds, at up to 20 m/s, as always with a guide, a native model or
  /// impulse injection.
  bool puts_reset_objects = true;
  double max_slew = 1e4;         ///< limit of the device force's rise [N/s]; may be infinite
  double max_peer_speed = 20.0;  ///< a peer's state that moved faster counts as a jump and is led
                                 ///< to smoothly [m/s]; may be infinite
  double fault_slew = 2000.0;    ///< rate at which the force fades after a fault [N/s]
};

/// Throws std::invalid_argument with the value's name and the allowed range.
void checkSiteSettings(const SiteSettings& settings);

/// The values that a number may have.
struct FieldRange {
  double least = 0.0;
  double most = std::numeric_limits<double>::max();
  bool excludes_least = false;
  const char* allowed = "a finite number, 0 or more";  ///< in refusals: "must be ..."

  [[nodiscard]] bool contains(double value) const noexcept;
};

/// One number or flag of SiteSettings. Doors use it to set the number by name: files, other
/// languages and the peers' agreement take names, units and ranges from here.
struct SiteField {
  const char* name;     ///< as in refusals: "contact.stiffness"
  const char* unit;     ///< "N/m"; empty: none
  const char* meaning;  ///< in a few words of Markdown
  FieldRange range;
  bool is_shared;  ///< all sites of a cooperation must have the same value
  bool is_flag;    ///< 0 or 1
  double (*get)(const SiteSettings& settings);
  void (*set)(SiteSettings& settings, double value);
};

/// Every number and flag that a door may set.
[[nodiscard]] const std::vector<SiteField>& siteFields();

/// Throws std::out_of_range if there is no such field.
[[nodiscard]] const SiteField& findSiteField(std::string_view name);

}  // namespace tandem
#pragma GCC visibility pop
