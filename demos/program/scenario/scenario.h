#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tandem/coordination/simulated_link.h"
#include "tandem/coordination/types.h"
#include "tandem/plugin/site_settings.h"

#include "scenario/body_scenario.h"
#include "scenario/site_scenario.h"

namespace tandem::demos {

/// A box of a site's own world that is not shared.
struct NeighbourBox {
  Vec3 position = Vec3::Zero();  ///< centre, scene frame [m]
  double size = 0.04;            ///< edge [m]
  double mass = 0.1;             ///< [kg]; 0: static
};

/// Tells of which scenarios Scenario::mayGrip() is true.
inline constexpr const char* kGripNeeds =
    "a hand holds the cube with experiment.guide = false, contact.model = island and "
    "bridge.injection = handoff";

/// Gains of coordination that a file leaves to the delay: "auto". loadScenario() chooses them.
struct AutoGains {
  bool stiffness = false, damping = false;
  [[nodiscard]] bool hasAny() const noexcept { return stiffness || damping; }
};

/// A scenario file, checked. Keys, meanings and units: docs/scenarios.md.
struct Scenario {
  std::string title;
  std::string text;  ///< what to try
  std::filesystem::path file;

  std::string kind = "cooperative_manipulation";
  std::string scheme = "remote_dynamic_proxy";
  double duration = 1.0;
  Vec3 axis = Vec3::UnitX();
  bool guide = true;

  /// Numbers of all sites. The members beside it set the rest, such as scheme and guide.
  SiteSettings site;
  AutoGains automatic;
  double angular_stiffness = -1.0;  ///< below 0: derived from the linear gains, see SiteSettings
  double angular_damping = -1.0;

  double object_mass = 0.2;
  double object_damping = 0.0;
  double object_size = 0.04;
  DeviceScenario device;  ///< of each site that has none of its own

  std::vector<SiteScenario> sites = std::vector<SiteScenario>(2);
  Impairments network{0.05};  ///< between each two sites
  /// One-way delays [s], by the number of the sender and of the receiver; empty: by
  /// `network.delay` and the sites' own. See computeDelay().
  std::vector<std::vector<double>> delays;
  double host_rate = 240.0;
  double inner_rate = 4000.0;

  double gravity = 0.0;   ///< along -z of the scene [m/s^2]
  bool floor = false;     ///< under the object
  double friction = 0.5;  ///< friction of all bodies of the world
  std::vector<NeighbourBox> boxes;
  std::vector<BodyScenario> bodies;  ///< of a world
  /// A world of another format, relative to the scenario. loadScenario() puts its bodies and joints
  /// among those of the scenario, and leaves this empty.
  std::string world_file;
  std::vector<std::string> shared;  ///< names of that file's bodies; empty afterwards, too
  std::vector<JointScenario> joints;
  CameraScenario camera;

  /// True if hands can hold the object.
  [[nodiscard]] bool mayGrip() const {
    return hasObject() && !guide && site.contact_model == ContactModel::kIsland &&
           site.injection == Injection::kHandoff;
  }
  [[nodiscard]] bool hasObject() const {
    if (!isWorld()) return kind != "user_contact";
    return !shared.empty() || std::ranges::any_of(bodies, &BodyScenario::shared);
  }
  /// True if its bodies are those of its tables [[body]].
  [[nodiscard]] bool isWorld() const { return kind == "world"; }
};

/// Reads a scenario, applies `overrides` ("key=value", dotted key), imports its world file, and
/// chooses gains that are "auto".
/// A world file may stand in place of a scenario: users' hands begin beside the first shared body.
/// Throws UsageError, one line: file, key, value, allowed values.
[[nodiscard]] Scenario loadScenario(const std::filesystem::path& file,
                                    const std::vector<std::string>& overrides);

/// The same from text, without the world file; `name` replaces the file in messages.
[[nodiscard]] Scenario parseScenario(const std::string& text, const std::string& name,
                                     const std::vector<std::string>& overrides);

/// The same scenario with other values, checked again. Throws UsageError.
[[nodiscard]] Scenario changeScenario(const Scenario& scenario,
                                      const std::vector<std::string>& overrides);

/// All keys that have a value, nested as in the file.
[[nodiscard]] nlohmann::json describeScenario(const Scenario& scenario);

/// The scenario that describeScenario() describes; `name` stands for its file in messages. Throws
/// UsageError as loadScenario() does.
[[nodiscard]] Scenario readScenario(const nlohmann::json& described, const std::string& name);

/// True for a key that is a site's own business: two sites of one cooperation may differ in it.
[[nodiscard]] bool isOwnKey(std::string_view name);

/// The tables of docs/scenarios.md in Markdown: all keys, those of each body and joint, and those
/// of each user's hand.
[[nodiscard]] std::array<std::string, 4> describeKeys();

}  // namespace tandem::demos
