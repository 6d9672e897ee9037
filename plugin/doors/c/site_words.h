#pragma once

#include <type_traits>
#include <utility>

#include "tandem/tandem.h"

namespace tandem::c_door {

/// A number of TandemSiteSettings that other languages set by name.
struct SiteWord {
  const char* word;   ///< the member's name
  const char* field;  ///< its name in siteFields()
  bool is_integer;
  bool is_flag;  ///< an integer that is 0 or 1
  double (*get)(const TandemSiteSettings& settings);
  void (*set)(TandemSiteSettings& settings, double value);
};

/// The number that the members of `Path` lead to, one within the other.
template <auto... Path, typename Settings>
constexpr auto& find(Settings& settings) {
  return (settings.*....*Path);
}

template <auto... Path>
constexpr SiteWord word(const char* word, const char* field, bool is_flag = false) {
  using Value = std::decay_t<decltype(find<Path...>(std::declval<TandemSiteSettings&>()))>;
  return {
      word,
      field,
      std::is_same_v<Value, int>,
      is_flag,
      [](const TandemSiteSettings& s) { return static_cast<double>(find<Path...>(s)); },
      [](TandemSiteSettings& s, double value) { find<Path...>(s) = static_cast<Value>(value); }};
}

template <auto... Path>
constexpr SiteWord word(const char* both) {
  return word<Path...>(both, both);
}

/// All but `self`, `scheme`, `coordination_mode`, `tick_source` and `guide`, which are no plain
/// numbers.
inline constexpr SiteWord kSiteWords[] = {
    word<&TandemSiteSettings::peers>("peers"),
    word<&TandemSiteSettings::haptic_rate>("haptic_rate"),
    word<&TandemSiteSettings::packet_rate>("packet_rate"),
    word<&TandemSiteSettings::packet_budget>("packet_budget"),
    word<&TandemSiteSettings::thins_when_idle>("thins_when_idle", "thins_when_idle", true),
    word<&TandemSiteSettings::host_step>("host_step"),
    word<&TandemSiteSettings::contact, &TandemGains::stiffness>("contact.stiffness"),
    word<&TandemSiteSettings::contact, &TandemGains::damping>("contact.damping"),
    word<&TandemSiteSettings::coordination, &TandemGains::stiffness>("coordination.stiffness"),
    word<&TandemSiteSettings::coordination, &TandemGains::damping>("coordination.damping"),
    word<&TandemSiteSettings::proxy_mass>("proxy_mass", "proxy.mass"),
    word<&TandemSiteSettings::proxy_damping>("proxy_damping", "proxy.damping"),
    word<&TandemSiteSettings::proxy_radius>("proxy_radius", "proxy.radius"),
    word<&TandemSiteSettings::hip_radius>("hip_radius"),
    word<&TandemSiteSettings::hand_group>("hand_group"),
    word<&TandemSiteSettings::hand_mask>("hand_mask"),
    word<&TandemSiteSettings::puts_reset_objects>("puts_reset_objects", "puts_reset_objects", true),
    word<&TandemSiteSettings::hand_feels_moving_bodies>("hand_feels_moving_bodies",
                                                        "hand_feels_moving_bodies", true),
    word<&TandemSiteSettings::inner_step>("inner_step"),
    word<&TandemSiteSettings::max_neighbours>("max_neighbours"),
    word<&TandemSiteSettings::link_loss>("link_loss", "link_loss.enabled", true),
    word<&TandemSiteSettings::membership_follows>("membership_follows", "membership.follows", true),
    word<&TandemSiteSettings::membership_leave_after>("membership_leave_after",
                                                      "membership.leave_after"),
    word<&TandemSiteSettings::passivity>("passivity", "passivity.enabled", true),
    word<&TandemSiteSettings::max_slew>("max_slew"),
    word<&TandemSiteSettings::fault_slew>("fault_slew"),
    word<&TandemSiteSettings::grip_stiffness>("grip_stiffness", "grip.stiffness"),
    word<&TandemSiteSettings::grip_damping_ratio>("grip_damping_ratio", "grip.damping_ratio"),
    word<&TandemSiteSettings::grip_radius>("grip_radius", "grip.radius"),
    word<&TandemSiteSettings::grip_max_force>("grip_max_force", "grip.max_force"),
    word<&TandemSiteSettings::grip_lift_time>("grip_lift_time", "grip.lift_time"),
    word<&TandemSiteSettings::grip_blend_time>("grip_blend_time", "grip.blend_time"),
    word<&TandemSiteSettings::grip_break_time>("grip_break_time", "grip.break_time"),
    word<&TandemSiteSettings::grip_fade_time>("grip_fade_time", "grip.fade_time"),
    word<&TandemSiteSettings::tool_stiffness>("tool_stiffness", "tool.stiffness"),
    word<&TandemSiteSettings::tool_damping_ratio>("tool_damping_ratio", "tool.damping_ratio"),
    word<&TandemSiteSettings::tool_radius>("tool_radius", "tool.radius"),
    word<&TandemSiteSettings::tool_max_force>("tool_max_force", "tool.max_force"),
};

}  // namespace tandem::c_door
