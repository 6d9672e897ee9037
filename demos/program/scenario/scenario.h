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

namespace tandem::demos {

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
  Vec3 start_offset =
      Vec3::Zero();  ///< start of the device, relative to "just in contact on the axis" [m]
};

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

  /// Numbers of both sites. The members beside it set the rest, such as scheme and guide.
  SiteSettings site;
  double angular_stiffness = -1.0;  ///< below 0: derived from the linear gains, see SiteSettings
  double angular_damping = -1.0;

  double object_mass = 0.2;
  double object_damping = 0.0;
  double object_size = 0.04;
  double device_mass = 0.1;
  double device_damping = 0.5;
  double encoder_resolution = 0.0;
  double device_max_force = 60.0;  ///< 0: no limit

  std::array<HandScenario, 2> hands;
  Impairments network{0.05};
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

/// Reads a scenario, applies `overrides` ("key=value", dotted key), and imports its world file.
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

/// All keys with their values, nested as in the file.
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
