#pragma once

#include <string_view>

/// \file
/// How a site is coupled to the others: gains, proxies, what silence and energy do to them.
#pragma GCC visibility push(default)
namespace tandem {

/// Gains of one spring-damper; checked where they enter (Island::addCoupler, Island::addContact).
struct CouplerGains {
  double stiffness = 0.0;  ///< [N/m], >= 0; higher feels stiffer and needs a shorter delay
  double damping = 0.0;    ///< [N s/m], >= 0; higher calms the coupling, too high rings with delay
};

/// The body that stands for a remote user where a scheme has one.
struct ProxySettings {
  double mass = 0.1;     ///< m_h, the mass of the remote user's device [kg]
  double damping = 0.0;  ///< b_h [N s/m]
  double radius = 0.01;  ///< of the sphere [m]
};

/// How a remote peer is doing, by the age of the state of it that was taken in last.
enum class LinkState {
  kWaiting,    ///< nothing heard yet, and it does not count as there
  kLive,       ///< heard lately: full gains
  kStale,      ///< late: what is pulled to stands, and its velocity dies away
  kFading,     ///< later: the gains go to zero
  kLost,       ///< silent: no contribution
  kRejoining,  ///< heard again: the gains come back
};

/// As it is written in reports: "live", "stale", ...
[[nodiscard]] std::string_view nameOf(LinkState state) noexcept;

/// What is done when a peer falls silent. Ages are for a sender whose packets come no farther apart
/// than a third of `stale_after`; for others they are longer, see LinkHealth.
struct LinkLossSettings {
  bool enabled = true;         ///< false: the last state heard pulls for ever
  bool start_live = true;      ///< until the first packet a peer counts as live, at its start pose
  double stale_after = 0.025;  ///< age at which targets stand [s]
  double fade_after = 0.1;     ///< age at which gains begin to fall [s]
  double lost_after = 0.25;    ///< age at which they are zero [s]
  double hold_decay = 0.02;    ///< time constant in which a stale velocity dies away [s]
  double ramp_in = 0.5;        ///< in which gains come back [s]
  double rejoin_overlap = 2e-3;  ///< as a pressing hand has it; a proxy deeper in something than
                                 ///< this is not let in again [m]
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkLinkLossSettings(const LinkLossSettings& settings);

/// What a hand may get out of a connection. Checked by checkPassivitySettings().
struct PassivitySettings {
  bool enabled = true;
  double tank = 0.02;  ///< may be given before anybody puts in any [J]; the paper needs 5.7 mJ
  double band = 0.01;  ///< below this rest the force fades [J], at most `tank`
  double most = 10.0;  ///< of what was put in counts as still there [J]: more than springs and
                       ///< moving masses of a scene hold; the rest has become heat
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkPassivitySettings(const PassivitySettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
