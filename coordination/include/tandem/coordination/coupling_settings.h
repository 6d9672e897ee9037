#pragma once

#include <string_view>

/// \file
/// Settings that couple a site to the others: gains, proxies, link loss and passivity.
#pragma GCC visibility push(default)
namespace tandem {

/// Gains of one spring-damper. Island::addCoupler and Island::addContact check them.
struct CouplerGains {
  double stiffness = 0.0;  ///< [N/m], >= 0; higher feels stiffer and needs a shorter delay
  double damping = 0.0;    ///< [N s/m], >= 0; higher calms the coupling, too high rings with delay
};

/// Says how the copies of an object, and the stand-ins of remote users, share K_t and B_t.
enum class CoordinationMode {
  kSum,      ///< each pair of copies is tied by K_t, B_t: stiffness and drag grow with N
  kAverage,  ///< each copy is tied to the mean of all N: K_t/N, B_t/N for each pair
};

/// The remote dynamic proxy: the body that stands for a remote user in some schemes.
struct ProxySettings {
  double mass = 0.1;     ///< m_h, the mass of the remote user's device [kg]
  double damping = 0.0;  ///< b_h, damping of the remote user's hand [N s/m]
  double radius = 0.01;  ///< radius of the sphere [m]
};

/// A stand-in of a remote user at this site: the whole user, or a part of it.
struct StandInSettings {
  double share = 1.0;  ///< of a whole user; it has to scale contacts, the rest has it already
  ProxySettings proxy;
  CouplerGains coordination;  ///< ties it to the user's delayed state
};

/// State of a remote peer, by the age of its last applied state.
enum class LinkState {
  kWaiting,    ///< nothing has arrived yet; the peer is absent
  kLive,       ///< a state arrived lately: full gains
  kStale,      ///< late: the target stands still and its velocity decays
  kFading,     ///< later: the gains fall to zero
  kLost,       ///< silent: no force
  kRejoining,  ///< states arrive again: the gains rise
};

/// Name of the state in reports: "live", "stale", ...
[[nodiscard]] std::string_view nameOf(LinkState state) noexcept;

/// Reaction to a silent peer. The ages hold for packet periods of at most a third of `stale_after`;
/// longer periods scale them up, see LinkHealth.
struct LinkLossSettings {
  bool enabled = true;         ///< false: the last state pulls forever
  bool start_live = true;      ///< a peer is live at its start pose until its first packet arrives
  double stale_after = 0.025;  ///< age at which targets stand still [s]
  double fade_after = 0.1;     ///< age at which gains begin to fall [s]
  double lost_after = 0.25;    ///< age at which gains are zero [s]
  double hold_decay = 0.02;    ///< time constant with which a stale velocity decays [s]
  double ramp_in = 0.5;        ///< time in which gains rise after a loss [s]
  double rejoin_overlap = 2e-3;  ///< a proxy that overlaps a body by more stays out [m]; 2 mm is a
                                 ///< pressing hand's overlap
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkLinkLossSettings(const LinkLossSettings& settings);

/// Limits of the energy a hand may extract. checkPassivitySettings() checks them.
struct PassivitySettings {
  bool enabled = true;
  double tank = 0.02;        ///< energy available at the start [J]; the paper needs 5.7 mJ
  double band = 0.01;        ///< the force fades below this remaining energy [J], at most `tank`
  double most = 2.0;         ///< most stored energy that counts [J]; the rest has become heat
  double power = 10.0;       ///< most that peers may grant [W]; bounds what a lying peer can give
  double least_mass = 0.05;  ///< least mass that the force moves [kg], device and hand
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkPassivitySettings(const PassivitySettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
