#include "world/scenario_device.h"

#include <limits>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// A hand whose forces are given in the scene's frame.
class SceneHand final : public Hand {
 public:
  SceneHand(std::unique_ptr<Hand> hand, const SceneFrame& frame)
      : hand_(std::move(hand)), frame_(frame) {}
  Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    const PointState handle_S{frame_.toScene(handle.p_W), frame_.toScene(handle.v_W)};
    return frame_.toWorld(hand_->computeForce(t, handle_S));
  }

 private:
  std::unique_ptr<Hand> hand_;
  SceneFrame frame_;
};

std::unique_ptr<Hand> makeHand(const Scenario& scenario, const SceneFrame& frame, int site) {
  const HandScenario& hand = scenario.sites[static_cast<std::size_t>(site)].hand;
  if (hand.kind == "sine") return makeSineHand(frame.toWorld(hand.force), hand.frequency, 0.0);
  if (hand.kind == "csv") {
    try {
      const std::filesystem::path path = scenario.file.parent_path() / hand.file;
      return std::make_unique<SceneHand>(makeRecordedHand(path.string()), frame);
    } catch (const Error& error) {
      throw UsageError(scenario.file.string() + ": site" + std::to_string(site + 1) +
                       ".hand_file = " + hand.file + ": " + error.what());
    }
  }
  if (hand.kind == "minimum_jerk") {
    const Vec3 start_W = computeStart(scenario, frame, site);
    std::vector<Waypoint> waypoints;
    for (const auto& [t, x, y, z] : hand.waypoints)
      waypoints.push_back({t, start_W + frame.toWorld(Vec3(x, y, z))});
    return makeMinimumJerkHand(std::move(waypoints), hand.stiffness, hand.damping);
  }
  return makeConstantHand(frame.toWorld(hand.force));
}

}  // namespace

std::unique_ptr<SimulatedDevice> makeScenarioDevice(const Scenario& scenario,
                                                    const SceneFrame& frame, int site) {
  SimulatedDeviceSettings settings;
  const DeviceScenario device =
      scenario.sites[static_cast<std::size_t>(site)].makeDevice(scenario.device);
  settings.mass = device.mass;
  settings.damping = device.damping;
  settings.start_W = computeStart(scenario, frame, site);
  if (scenario.guide) settings.guide = scenario.axis;
  settings.encoder_resolution = device.encoder_resolution;
  settings.max_force =
      device.max_force > 0.0 ? device.max_force : std::numeric_limits<double>::infinity();
  return std::make_unique<SimulatedDevice>(settings, makeHand(scenario, frame, site));
}

}  // namespace tandem::demos
