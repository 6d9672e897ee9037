#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/coupling_settings.h"
#include "tandem/coordination/types.h"

namespace tandem::demos {

/// Fewest and most sites of a scenario.
inline constexpr std::size_t kFewestSites = 2, kMostSites = 16;

/// Action of a simulated user's hand; vectors in the scene's own frame.
struct HandScenario {
  std::string kind = "constant";  ///< constant, sine, minimum_jerk, csv
  Vec3 force = Vec3::Zero();      ///< constant force, or amplitude of the sine [N]
  double frequency = 1.0;         ///< frequency of the sine [Hz]
  double stiffness = 300.0;       ///< stiffness of a hand that follows waypoints [N/m]
  double damping = 5.0;           ///< [N s/m]
  std::vector<std::array<double, 4>> waypoints;  ///< t, and displacement from the start [s, m]
  std::vector<std::array<double, 2>> grips;      ///< times in which the hand holds the object [s]
  std::string file;                              ///< file of the csv hand, relative to the scenario
  /// Start of the device, relative to its place "just in contact" [m].
  Vec3 start_offset = Vec3::Zero();
};

/// A simulated device.
struct DeviceScenario {
  double mass = 0.1;                ///< [kg]
  double damping = 0.5;             ///< b_dev [N s/m]
  double encoder_resolution = 0.0;  ///< [m]; 0: exact
  double max_force = 60.0;          ///< [N]; 0: no limit
};

/// A site of a scenario: its user's hand, and what it has instead of the scenario's own values.
struct SiteScenario {
  HandScenario hand;
  std::optional<double> device_mass, device_damping, device_encoder_resolution, device_max_force;
  std::optional<double> contact_stiffness, contact_damping;
  std::optional<double> delay;        ///< added to that of each way from and to this site [s]
  std::optional<double> comes, goes;  ///< the user is connected from then until then [s]

  /// The site's device, where a scenario's devices are `usual`.
  [[nodiscard]] DeviceScenario makeDevice(const DeviceScenario& usual) const {
    return {device_mass.value_or(usual.mass), device_damping.value_or(usual.damping),
            device_encoder_resolution.value_or(usual.encoder_resolution),
            device_max_force.value_or(usual.max_force)};
  }
  /// The site's contact gains, where a scenario's are `usual`.
  [[nodiscard]] CouplerGains makeContact(const CouplerGains& usual) const {
    return {contact_stiffness.value_or(usual.stiffness), contact_damping.value_or(usual.damping)};
  }
};

}  // namespace tandem::demos
