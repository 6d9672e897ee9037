#include "world/scene_shapes.h"

#include <fmt/format.h>

#include <LinearMath/btConvexHullComputer.h>

#include "tandem/bullet_bridge/convert.h"

#include "terminal/usage_error.h"
#include "world/rotation.h"

namespace tandem::demos {
namespace {

/// Rounding of a hull or cone, and skin of a mesh [m]. Bullet's own 40 mm is for things of metres.
constexpr auto kMargin = static_cast<btScalar>(1e-3);

btScalar toScalar(const std::optional<double>& length) {
  return static_cast<btScalar>(length.value_or(0.0));
}

/// A convex form that numbers describe; null for others.
std::unique_ptr<btCollisionShape> makeRound(const ShapeScenario& form) {
  const btScalar radius = toScalar(form.radius), height = toScalar(form.height);
  if (form.kind == "sphere") return std::make_unique<btSphereShape>(radius);
  if (form.kind == "capsule") return std::make_unique<btCapsuleShapeZ>(radius, height);
  if (form.kind == "cylinder")
    return std::make_unique<btCylinderShapeZ>(btVector3(radius, radius, btScalar(0.5) * height));
  if (form.kind != "cone") return nullptr;
  auto cone = std::make_unique<btConeShapeZ>(radius, height);
  cone->setMargin(kMargin);
  return cone;
}

void addTriangles(const ShapeScenario& form, btTriangleMesh& mesh) {
  const auto corner = [&](int number) {
    return toBullet(Vec3(form.points[static_cast<std::size_t>(number)].data()));
  };
  for (const auto& [a, b, c] : form.triangles) mesh.addTriangle(corner(a), corner(b), corner(c));
}

}  // namespace

btCollisionShape& SceneShapes::make(const BodyScenario& body) {
  const std::string key = "body." + body.name;
  if (body.parts.empty()) return makeForm(body.shape, key);
  auto compound = std::make_unique<btCompoundShape>();
  for (const PartScenario& part : body.parts)
    compound->addChildShape(
        btTransform(toBullet(makeRotation(part.rotation)), toBullet(part.position)),
        &makeForm(part.shape, key + ".parts"));
  shapes_.push_back(std::move(compound));
  return *shapes_.back();
}

btCollisionShape& SceneShapes::makeForm(const ShapeScenario& form, const std::string& key) {
  std::unique_ptr<btCollisionShape> shape = makeRound(form);
  if (form.kind == "box") shape = std::make_unique<btBoxShape>(toBullet(0.5 * *form.size));
  if (form.kind == "hull") shape = makeHull(form, key);
  if (form.kind == "mesh") shape = makeMesh(form);
  shapes_.push_back(std::move(shape));
  return *shapes_.back();
}

std::unique_ptr<btCollisionShape> SceneShapes::makeHull(const ShapeScenario& form,
                                                        const std::string& key) {
  std::vector<btVector3> points;
  for (const auto& [x, y, z] : form.points) points.push_back(toBullet(Vec3(x, y, z)));
  btConvexHullComputer hull;
  hull.compute(points.data()->m_floats, sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
  if (hull.faces.size() < 4)
    throw UsageError(fmt::format("{}: its points lie in a plane; a hull needs a volume", key));
  auto shape = std::make_unique<btConvexHullShape>(&hull.vertices[0][0], hull.vertices.size(),
                                                   static_cast<int>(sizeof(btVector3)));
  shape->setMargin(kMargin);
  shape->recalcLocalAabb();
  return shape;
}

std::unique_ptr<btCollisionShape> SceneShapes::makeMesh(const ShapeScenario& form) {
  auto mesh = std::make_unique<btTriangleMesh>();
  addTriangles(form, *mesh);
  auto shape = std::make_unique<btBvhTriangleMeshShape>(mesh.get(), true);
  shape->setMargin(kMargin);
  meshes_.push_back(std::move(mesh));
  return shape;
}

}  // namespace tandem::demos
