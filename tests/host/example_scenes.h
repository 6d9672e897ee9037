#pragma once

#include <ostream>
#include <vector>

#include "host/example_host.h"

namespace tandem::test {

/// One of Bullet's own examples (examples/ in its repository), built anew with the same dimensions,
/// masses and settings, without sliders, keys and graphics.
struct ExampleScene {
  const char* name;  ///< of Bullet's class or function
  void (*build)(ExampleHost& host);
  double duration = 20.0;  ///< of a test [s]; less for scenes that took more than 3 s
  /// False: with a hand everything stays finite, but energy is gained that nobody gave.
  bool bounds_energy = true;
};

/// GoogleTest would print bytes, with addresses.
inline void PrintTo(const ExampleScene& scene, std::ostream* out) { *out << scene.name; }

/// Stacks, slopes and shapes in a btDiscreteDynamicsWorld.
[[nodiscard]] std::vector<ExampleScene> rigidScenes();
/// The scenes of Bullet's BenchmarkDemo that need no data.
[[nodiscard]] std::vector<ExampleScene> benchmarkScenes();
/// Joints, motors and vehicles in a btDiscreteDynamicsWorld.
[[nodiscard]] std::vector<ExampleScene> jointScenes();
[[nodiscard]] std::vector<ExampleScene> constraintScenes();
/// Scenes in a btMultiBodyDynamicsWorld.
[[nodiscard]] std::vector<ExampleScene> multiBodyScenes();
/// Scenes in a btSoftRigidDynamicsWorld.
[[nodiscard]] std::vector<ExampleScene> softScenes();

/// All of them.
[[nodiscard]] inline std::vector<ExampleScene> exampleScenes() {
  std::vector<ExampleScene> all;
  for (const auto& some : {rigidScenes(), benchmarkScenes(), jointScenes(), constraintScenes(),
                           multiBodyScenes(), softScenes()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace tandem::test
