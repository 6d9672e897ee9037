#include "import/file_scenario.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tandem/bullet_bridge/convert.h"

#include "scenario/user_places.h"
#include "terminal/usage_error.h"
#include "world/scene_world.h"

namespace tandem::demos {
namespace {

constexpr double kGap = 0.02;  // between a hand and the body at first [m]

constexpr const char* kText = R"(title = {0}
[experiment]
kind = "world"
guide = false
duration = 10.0
[contact]
stiffness = 1000.0
damping = 5.0
[coordination]
stiffness = 200.0
damping = 10.0
[device]
damping = 2.0
[rates]
host = 60.0
[world]
gravity = 9.81
file = {0}
)";

[[noreturn]] void refuseWithoutShare(const Scenario& scenario) {
  std::vector<std::string> names;
  for (const BodyScenario& body : scenario.bodies)
    if (body.mass > 0.0) names.push_back(body.name);
  throw UsageError(fmt::format("{}: name a body that both users move: --share NAME; there are: {}",
                               scenario.file.string(), fmt::join(names, ", ")));
}

}  // namespace

std::string describeFileScenario(const std::filesystem::path& file) {
  return fmt::format(kText, nlohmann::json(file.filename().string()).dump());
}

void placeUsers(Scenario& scenario) {
  if (!scenario.hasObject()) refuseWithoutShare(scenario);
  const SceneWorld scene(scenario);
  const auto shared = std::ranges::find_if(
      scene.bodies(), [](const PlacedBody& placed) { return placed.plan.body.shared; });
  btVector3 low_W, high_W;
  shared->body->getAabb(low_W, high_W);
  const Vec3 low = scene.frame().toScene(fromBullet(low_W));
  const Vec3 high = scene.frame().toScene(fromBullet(high_W));
  const Vec3 half = 0.5 * (high - low).cwiseAbs(), middle = 0.5 * (low + high);
  const double distance = half.x() + scenario.site.proxy.radius + kGap;
  for (std::size_t i = 0; i < scenario.sites.size(); ++i) {
    // There may be a floor, so the lowest row of hands is as high as the body's middle.
    const double row = computePlaceBeside(scenario, i, 0.0).z();
    const double lowest = computePlaceBeside(scenario, i % 2, 0.0).z();
    const Vec3 beside = computePlaceBeside(scenario, i, distance);
    if (Vec3& place = scenario.sites[i].hand.start_offset; place == Vec3::Zero())
      place = middle + Vec3(beside.x(), beside.y(), row - lowest);
  }
  if (scenario.camera.distance > 0.0) return;
  scenario.camera.target = middle;
  scenario.camera.distance = 0.3 + 5.0 * half.maxCoeff();
}

std::vector<std::string> addShares(std::vector<std::string> overrides,
                                   const std::vector<std::string>& names) {
  if (!names.empty()) overrides.push_back("world.share=" + nlohmann::json(names).dump());
  return overrides;
}

}  // namespace tandem::demos
