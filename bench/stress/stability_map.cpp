#include "bench/stress/stability_map.h"

#include <algorithm>
#include <cmath>

#include "bench/methods/all_methods.h"

namespace tandem::demos::bench {
namespace {

constexpr double kRadius = 0.01, kHalf = 0.05;  // radius of the sphere, half edge of the cube [m]
constexpr double kReleased = 0.01;              // start above the surface [m]
constexpr double kPressed = 0.005;              // target, below the surface [m]

double computeDamping(double stiffness) {
  // Damping of each coupler: both together have the ratio.
  return MapScene::kDampingRatio * std::sqrt(2.0 * stiffness * MapScene::kMass);
}

BenchScene makeScene(double stiffness) {
  BenchScene scene;
  scene.name = "map";
  scene.coupler = scene.contact = {stiffness, computeDamping(stiffness)};
  BenchTool tool;
  tool.radius = kRadius;
  tool.mass = MapScene::kMass;
  tool.start.p_W = (kHalf + kRadius + kReleased) * Vec3::UnitX();
  tool.device = [](double) {
    return PointState{(kHalf + kRadius - kPressed) * Vec3::UnitX(), Vec3::Zero()};
  };
  scene.tools.push_back(tool);
  BenchBody cube;
  cube.name = "cube";
  cube.shape = BoxShape{Vec3::Constant(kHalf)};
  scene.bodies.push_back(cube);
  scene.is_smooth = true;
  // Long enough to come to rest, or to show instability.
  const double frequency = std::sqrt(stiffness / MapScene::kMass);
  scene.duration = std::max(0.5, 60.0 / frequency);
  return scene;
}

/// Energy of the sphere in the springs of the model [J].
double computeEnergy(const BenchScene& scene, const PointState& tool) {
  const Vec3 stretch_W = tool.p_W - scene.tools.front().device(0.0).p_W;
  const double overlap = std::max(0.0, kHalf + kRadius - tool.p_W.x());
  return 0.5 * MapScene::kMass * tool.v_W.squaredNorm() +
         0.5 * scene.coupler.stiffness * stretch_W.squaredNorm() +
         0.5 * scene.contact.stiffness * overlap * overlap;
}

/// Unstable if in the last half the sphere has, at any time, more energy than at its release.
Stability judge(const Method& method, double stiffness, int host_rate) {
  const BenchScene scene = makeScene(stiffness);
  SceneState state = startState(scene);
  const double start = computeEnergy(scene, state.tools.front());
  const auto steps = static_cast<int>(std::max(200.0, scene.duration * host_rate));
  double late = 0.0;
  try {
    const auto simulation = method.start(scene, host_rate);
    for (int n = 0; n < steps; ++n) {
      simulation->step();
      simulation->read(state);
      const PointState& tool = state.tools.front();
      const double energy = computeEnergy(scene, tool);
      if (!std::isfinite(energy)) return Stability::kNotFinite;
      if (2 * n > steps) late = std::max(late, energy);
    }
  } catch (const NotApplicable&) {
    return Stability::kNotApplicable;
  }
  return late > start ? Stability::kGrows : Stability::kStable;
}

const char* const kMethods[] = {"plugin handoff", "force injection",    "Bullet rigid",
                                "Bullet soft",    "Bullet 6DofSpring2", "Bullet Point2Point"};

}  // namespace

std::string_view nameOf(Stability stability) {
  constexpr std::string_view kNames[] = {"stable", "grows", "not_finite", "not_applicable"};
  return kNames[static_cast<int>(stability)];
}

double computeInjectionLimit(double stiffness) {
  const double w = std::sqrt(2.0 * stiffness / MapScene::kMass);
  const double z = 2.0 * computeDamping(stiffness) / (2.0 * w * MapScene::kMass);
  return 2.0 / w * (std::sqrt(z * z + 1.0) - z);
}

std::vector<StabilityMap> makeStabilityMaps(
    bool quick, const std::function<void(std::string_view, double)>& progress) {
  const int stiff_count = quick ? 11 : 26, rate_count = quick ? 8 : 20;
  std::vector<StabilityMap> maps;
  for (const char* name : kMethods) {
    const auto& all = allMethods();
    const auto method =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return one->name() == name; });
    StabilityMap map;
    map.method = name;
    for (int k = 0; k < stiff_count; ++k)
      map.stiffness.push_back(std::pow(10.0, 1.0 + 5.0 * k / (stiff_count - 1)));
    for (int r = 0; r < rate_count; ++r)
      map.host_rates.push_back(static_cast<int>(
          std::lround(30.0 * std::pow(1000.0 / 30.0, static_cast<double>(r) / (rate_count - 1)))));
    for (const double stiffness : map.stiffness) {
      progress(map.method, (static_cast<double>(maps.size()) +
                            static_cast<double>(map.cells.size()) / (stiff_count * rate_count)) /
                               static_cast<double>(std::size(kMethods)));
      for (const int rate : map.host_rates) map.cells.push_back(judge(**method, stiffness, rate));
    }
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace tandem::demos::bench
