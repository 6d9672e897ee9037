#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "tandem/plugin/site_settings.h"

namespace tandem {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr FieldRange kNotNegative{};
constexpr FieldRange kPositive{0.0, kLargest, true, "a finite number above 0"};
constexpr FieldRange kPositiveOrInfinite{0.0, kInfinity, true, "above 0; inf: no limit"};
constexpr FieldRange kRate{0.0, 1e5, true, "above 0 and at most 1e5 Hz"};
constexpr FieldRange kInnerStep{1e-6, kLargest, false, "at least 1e-6 s"};
constexpr FieldRange kStall{0.0, 100.0, false, "0 to 100 s"};
constexpr FieldRange kPeers{1.0, 64.0, false, "1 to 64"};
constexpr FieldRange kNeighbours{0.0, 256.0, false, "0 to 256"};
constexpr FieldRange kBits{-2147483648.0, 2147483647.0, false, "a whole number of 32 bits"};
constexpr FieldRange kFlag{0.0, 1.0, false, "0 or 1"};

/// Whether the sites of a cooperation must agree on a field.
enum Whose { kShared, kOwn };

/// The member that the members of `Path` lead to, one within the other.
template <auto... Path, typename Settings>
constexpr auto& find(Settings& settings) {
  return (settings.*....*Path);
}

template <auto... Path>
SiteField field(const char* name, const char* unit, const char* meaning, const FieldRange& range,
                Whose whose) {
  using Value = std::decay_t<decltype(find<Path...>(std::declval<SiteSettings&>()))>;
  return {name,
          unit,
          meaning,
          range,
          whose == kShared,
          std::is_same_v<Value, bool>,
          [](const SiteSettings& s) { return static_cast<double>(find<Path...>(s)); },
          [](SiteSettings& s, double value) { find<Path...>(s) = static_cast<Value>(value); }};
}

std::vector<SiteField> makeFields() {
  using S = SiteSettings;
  using Gains = CouplerGains;
  return {
      field<&S::peers>("peers", "", "N: each of N copies of a shared object carries m/N", kPeers,
                       kShared),
      field<&S::haptic_rate>("haptic_rate", "Hz", "device loop", kRate, kShared),
      field<&S::packet_rate>("packet_rate", "Hz", "packets per second", kRate, kShared),
      field<&S::packet_budget>("packet_budget", "bit/s", "sent to all peers together; 0: no limit",
                               kNotNegative, kOwn),
      field<&S::thins_when_idle>("thins_when_idle", "", "fewer packets while nothing moves", kFlag,
                                 kOwn),
      field<&S::host_step>("host_step", "s", "expected first step of the host; 0: learnt from it",
                           kNotNegative, kOwn),
      field<&S::contact, &Gains::stiffness>("contact.stiffness", "N/m",
                                            "K_vc, of every contact of a device or proxy",
                                            kNotNegative, kShared),
      field<&S::contact, &Gains::damping>("contact.damping", "N s/m", "B_vc", kNotNegative,
                                          kShared),
      field<&S::coordination, &Gains::stiffness>(
          "coordination.stiffness", "N/m", "K_t, proxies to users and object copies to each other",
          kNotNegative, kShared),
      field<&S::coordination, &Gains::damping>("coordination.damping", "N s/m", "B_t", kNotNegative,
                                               kShared),
      field<&S::proxy, &ProxySettings::mass>("proxy.mass", "kg", "m_h of a proxy", kPositive,
                                             kShared),
      field<&S::proxy, &ProxySettings::damping>("proxy.damping", "N s/m", "b_h", kNotNegative,
                                                kShared),
      field<&S::proxy, &ProxySettings::radius>("proxy.radius", "m", "of proxies", kPositive,
                                               kShared),
      field<&S::grip, &GripSettings::stiffness>("grip.stiffness", "N/m",
                                                "K of the spring between a hand and what it holds",
                                                kPositive, kShared),
      field<&S::grip, &GripSettings::damping_ratio>(
          "grip.damping_ratio", "", "of that spring with hand and object", kNotNegative, kShared),
      field<&S::grip, &GripSettings::radius>(
          "grip.radius", "m", "the torque's spring has K times its square", kNotNegative, kShared),
      field<&S::grip, &GripSettings::max_force>("grip.max_force", "N",
                                                "at which a grip breaks; times the radius: torque",
                                                kPositive, kShared),
      field<&S::grip, &GripSettings::lift_time>(
          "grip.lift_time", "s", "within which a hand takes over a weight; 0: objects sag",
          kNotNegative, kShared),
      field<&S::grip, &GripSettings::blend_time>("grip.blend_time", "s",
                                                 "within which an object comes to the hand",
                                                 kNotNegative, kShared),
      field<&S::grip, &GripSettings::break_time>(
          "grip.break_time", "s", "at the limit, after which the grip breaks", kNotNegative, kOwn),
      field<&S::grip, &GripSettings::fade_time>(
          "grip.fade_time", "s", "of the force after a release", kNotNegative, kShared),
      field<&S::tool, &ToolSettings::stiffness>("tool.stiffness", "N/m",
                                                "K of the spring between a hand and its tool",
                                                kPositive, kShared),
      field<&S::tool, &ToolSettings::damping_ratio>(
          "tool.damping_ratio", "", "of that spring with hand and tool", kNotNegative, kShared),
      field<&S::tool, &ToolSettings::radius>(
          "tool.radius", "m", "the torque's spring has K times its square", kNotNegative, kShared),
      field<&S::tool, &ToolSettings::max_force>(
          "tool.max_force", "N", "of the hold; times the radius: torque", kPositive, kShared),
      field<&S::hip_radius>("hip_radius", "m", "of the local haptic interface point", kPositive,
                            kOwn),
      field<&S::hand_group>("hand_group", "", "collision group of the hand and of proxies", kBits,
                            kOwn),
      field<&S::hand_mask>("hand_mask", "", "collision groups that the hand and proxies meet",
                           kBits, kOwn),
      field<&S::hand_feels_moving_bodies>(
          "hand_feels_moving_bodies", "",
          "with nothing shared, too; 0: the host's simulation stays the same to the bit", kFlag,
          kOwn),
      field<&S::inner_step>("inner_step", "s", "step of the island where motion is not linear",
                            kInnerStep, kOwn),
      field<&S::max_neighbours>("max_neighbours", "",
                                "bodies of the host that the island may hold at a time",
                                kNeighbours, kOwn),
      field<&S::host_stall>("host_stall", "s", "time for which the host may be silent", kStall,
                            kOwn),
      field<&S::link_loss, &LinkLossSettings::enabled>(
          "link_loss.enabled", "",
          "a silent peer's gains fade; false: its last state pulls for ever", kFlag, kShared),
      field<&S::membership, &MembershipSettings::follows>(
          "membership.follows", "", "N follows who is there; 0: it is fixed", kFlag, kShared),
      field<&S::membership, &MembershipSettings::leave_after>(
          "membership.leave_after", "s", "silence after which a peer no longer counts", kPositive,
          kShared),
      field<&S::passivity, &PassivitySettings::enabled>(
          "passivity.enabled", "",
          "the hand gets no more energy than others and itself put in, and the tank", kFlag, kOwn),
      field<&S::passivity, &PassivitySettings::tank>(
          "passivity.tank", "J", "energy that the hand may get before anybody puts in any",
          kPositive, kOwn),
      field<&S::passivity, &PassivitySettings::power>(
          "passivity.power", "W", "energy that peers may grant the hand per second", kNotNegative,
          kOwn),
      field<&S::max_slew>("max_slew", "N/s", "rise of the force at the device", kPositiveOrInfinite,
                          kOwn),
      field<&S::max_peer_speed>("max_peer_speed", "m/s",
                                "a peer's state that moved faster is approached smoothly",
                                kPositiveOrInfinite, kOwn),
      field<&S::puts_reset_objects>(
          "puts_reset_objects", "",
          "an object that a peer's host put elsewhere is put there at once; 0: it is led there",
          kFlag, kOwn),
      field<&S::fault_slew>("fault_slew", "N/s", "after a fault the force fades by this", kPositive,
                            kOwn),
  };
}

}  // namespace

bool FieldRange::contains(double value) const noexcept {
  return (excludes_least ? value > least : value >= least) && value <= most;
}

const std::vector<SiteField>& siteFields() {
  static const std::vector<SiteField> fields = makeFields();
  return fields;
}

const SiteField& findSiteField(std::string_view name) {
  const auto& all = siteFields();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const SiteField& f) { return f.name == name; });
  if (found == all.end()) throw std::out_of_range("no field of a site: " + std::string(name));
  return *found;
}

}  // namespace tandem
