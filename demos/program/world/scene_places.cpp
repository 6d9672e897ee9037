#include "world/scene_places.h"

#include <algorithm>

namespace tandem::demos {
namespace {

constexpr double kFarAway = 1000.0;  // [m]

bool isNear(const Vec3& p_W) { return (p_W.array().abs() < kFarAway).all(); }

}  // namespace

bool ScenePlaces::areNear() const {
  const auto is_body_near = [](const auto& body) {
    return isNear(body.second.p_W) && body.second.q_WB.coeffs().allFinite();
  };
  return std::ranges::all_of(hands_W, isNear) && std::ranges::all_of(bodies, is_body_near);
}

void startHandsAt(const ScenePlaces& places, Scenario& scenario) {
  const SceneFrame frame = makeSceneFrame(scenario);
  for (std::size_t user = 0; user < places.hands_W.size(); ++user) {
    const Vec3 away_W =
        places.hands_W[user] - computeStart(scenario, frame, static_cast<int>(user));
    scenario.sites[user].hand.start_offset += frame.toScene(away_W);
  }
}

}  // namespace tandem::demos
