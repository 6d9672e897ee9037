#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "scenario/body_scenario.h"

namespace tandem::demos {

/// Makes Bullet's shapes of a scenario's forms, and keeps them.
class SceneShapes {
 public:
  /// The shape of a body, about its origin. Lives as long as this. Files must have been read.
  /// Throws UsageError for a hull without volume.
  [[nodiscard]] btCollisionShape& make(const BodyScenario& body);

 private:
  [[nodiscard]] btCollisionShape& makeForm(const ShapeScenario& form, const std::string& key);
  [[nodiscard]] static std::unique_ptr<btCollisionShape> makeHull(const ShapeScenario& form,
                                                                  const std::string& key);
  [[nodiscard]] std::unique_ptr<btCollisionShape> makeMesh(const ShapeScenario& form);

  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;  // outlive the shapes that use them
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
};

}  // namespace tandem::demos
