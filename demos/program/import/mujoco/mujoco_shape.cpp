#include "import/mujoco/mujoco_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "import/import_parts.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

using Points = std::vector<std::array<double, 3>>;

constexpr int kRings = 8;  // of the hull of an ellipsoid

Points sampleEllipsoid(const mjtNum* radii) {
  Points points;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int side = 0; side < 2 * kRings; ++side) {
      const double polar = std::numbers::pi * ring / kRings;
      const double around = std::numbers::pi * side / kRings;
      points.push_back({radii[0] * std::sin(polar) * std::cos(around),
                        radii[1] * std::sin(polar) * std::sin(around), radii[2] * std::cos(polar)});
    }
  return points;
}

std::array<double, 3> corner(const mjModel& model, int vertex) {
  const float* p = model.mesh_vert + 3 * vertex;
  return {p[0], p[1], p[2]};
}

/// Corners of the mesh's hull where MuJoCo has it, else all.
Points findHull(const mjModel& model, int mesh) {
  const int first = model.mesh_vertadr[mesh];
  Points points;
  if (const int graph = model.mesh_graphadr[mesh]; graph >= 0) {
    // MuJoCo's graph: numbers of corners and faces, an address for each corner, then its vertex.
    const int* numbers = model.mesh_graph + graph;
    for (int i = 0; i < numbers[0]; ++i)
      points.push_back(corner(model, first + numbers[2 + numbers[0] + i]));
  } else {
    for (int i = 0; i < model.mesh_vertnum[mesh]; ++i) points.push_back(corner(model, first + i));
  }
  return points;
}

ShapeScenario makeMesh(const mjModel& model, int mesh, bool moves) {
  ShapeScenario shape;
  shape.kind = moves ? "hull" : "mesh";
  if (moves) {
    shape.points = findHull(model, mesh);
    return shape;
  }
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i)
    shape.points.push_back(corner(model, model.mesh_vertadr[mesh] + i));
  for (int i = 0; i < model.mesh_facenum[mesh]; ++i) {
    const int* face = model.mesh_face + 3 * (model.mesh_faceadr[mesh] + i);
    shape.triangles.push_back({face[0], face[1], face[2]});
  }
  return shape;
}

ShapeScenario makeRound(const char* kind, const mjtNum* size) {
  ShapeScenario shape;
  shape.kind = kind;
  shape.radius = size[0];
  if (shape.kind != "sphere") shape.height = 2.0 * size[1];
  return shape;
}

ShapeScenario makeBox(const Vec3& size) {
  ShapeScenario shape;
  shape.size = size;
  return shape;
}

bool isSolid(const mjModel& model, int geom) {
  return model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
}

}  // namespace

MujocoPose poseOfGeom(const MujocoModel& world, int geom) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const mjtNum* position = world.start->geom_xpos + 3 * geom;
  const mjtNum* rows = world.start->geom_xmat + 9 * geom;
  MujocoPose pose{Vec3(position), Mat3(Eigen::Map<const RowMajor>(rows))};
  if (world.model->geom_type[geom] == mjGEOM_PLANE)
    pose.p_W -= 0.5 * kGroundThickness * pose.R_W.col(2);
  return pose;
}

ShapeScenario makeShape(const MujocoModel& world, int geom, bool moves) {
  const mjModel& model = *world.model;
  const mjtNum* size = model.geom_size + 3 * geom;
  const auto widthOf = [](mjtNum half) { return half > 0.0 ? 2.0 * half : kGroundWidth; };
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return makeRound("sphere", size);
    case mjGEOM_CAPSULE:
      return makeRound("capsule", size);
    case mjGEOM_CYLINDER:
      return makeRound("cylinder", size);
    case mjGEOM_BOX:
      return makeBox(2.0 * Vec3(size));
    case mjGEOM_PLANE:
      return makeBox(Vec3(widthOf(size[0]), widthOf(size[1]), kGroundThickness));
    case mjGEOM_MESH:
      return makeMesh(model, model.geom_dataid[geom], moves);
    case mjGEOM_ELLIPSOID: {
      ShapeScenario shape;
      shape.kind = "hull";
      shape.points = sampleEllipsoid(size);
      return shape;
    }
    default:
      throw UsageError("a height field is not taken over; make it a mesh");
  }
}

std::vector<int> findSolidGeoms(const mjModel& model, int body) {
  std::vector<int> solid, all;
  for (int i = 0; i < model.body_geomnum[body]; ++i) {
    const int geom = model.body_geomadr[body] + i;
    all.push_back(geom);
    if (isSolid(model, geom)) solid.push_back(geom);
  }
  return solid.empty() ? all : solid;
}

std::string findColour(const mjModel& model, int body) {
  for (int i = 0; i < model.body_geomnum[body]; ++i) {
    const int geom = model.body_geomadr[body] + i, material = model.geom_matid[geom];
    const float* colour =
        material >= 0 ? model.mat_rgba + 4 * material : model.geom_rgba + 4 * geom;
    const bool is_default = colour[0] == 0.5F && colour[1] == 0.5F && colour[2] == 0.5F;
    const auto byte = [&](int k) { return std::lround(255.0F * std::clamp(colour[k], 0.F, 1.F)); };
    if (!is_default) return fmt::format("#{:02X}{:02X}{:02X}", byte(0), byte(1), byte(2));
  }
  return {};
}

}  // namespace tandem::demos
