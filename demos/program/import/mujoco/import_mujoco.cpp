#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "import/body_names.h"
#include "import/import_file.h"
#include "import/import_parts.h"
#include "import/imported_world.h"
#include "import/mass_sum.h"
#include "import/mujoco/mujoco_model.h"
#include "import/mujoco/mujoco_shape.h"
#include "import/trial.h"
#include "terminal/usage_error.h"
#include "world/rotation.h"

namespace tandem::demos {
namespace {

constexpr double kDot = 1e-3;  // radius of a body without a form [m]

/// Turns a compiled model into bodies and joints. MuJoCo's "weld group" is one body here.
class Importer {
 public:
  explicit Importer(const MujocoModel& world) : world_(world), model_(*world.model) {}

  ImportedWorld import() {
    for (int body = 0; body < model_.nbody; ++body) {
      const int root = model_.body_weldid[body];
      if (root == 0)
        addStatic(body);
      else if (root == body)
        addMoving(root);
      else
        result_.names[nameOf(body)] = result_.names[nameOf(root)];
    }
    for (int joint = 0; joint < model_.njnt; ++joint) addJoint(joint);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::string nameOf(int body) const {
    return model_.names + model_.name_bodyadr[body];
  }

  /// Each geom that stands is a body of its own: meshes are no parts.
  void addStatic(int body) {
    for (const int geom : findSolidGeoms(model_, body)) {
      const std::string own = model_.names + model_.name_geomadr[geom];
      const MujocoPose pose = poseOfGeom(world_, geom);
      BodyScenario made;
      made.name = names_.make(own.empty() ? nameOf(body) : own);
      made.shape = makeShape(world_, geom, false);
      made.position = pose.p_W;
      made.rotation = makeRotationVector(pose.R_W);
      made.colour = findColour(model_, body);
      result_.names.emplace(nameOf(body), made.name);
      result_.bodies.push_back(made);
    }
  }

  void addMoving(int root) {
    MassSum sum;
    std::vector<int> geoms;
    BodyScenario made;
    for (int body = root; body < model_.nbody; ++body) {
      if (model_.body_weldid[body] != root) continue;
      addMass(body, sum);
      for (const int geom : findSolidGeoms(model_, body)) geoms.push_back(geom);
      if (made.colour.empty()) made.colour = findColour(model_, body);
    }
    made.name = names_.make(nameOf(root));
    place(made, sum, geoms.empty() ? Mat3::Identity() : poseOfGeom(world_, geoms[0]).R_W);
    for (const int geom : geoms) addPart(geom, made);
    simplify(made);
    result_.names[nameOf(root)] = made.name;
    result_.bodies.push_back(made);
  }

  void addMass(int body, MassSum& sum) const {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    const Mat3 axes = Eigen::Map<const RowMajor>(world_.start->ximat + 9 * body);
    const Vec3 principal(model_.body_inertia + 3 * body);
    sum.add(model_.body_mass[body], Vec3(world_.start->xipos + 3 * body),
            axes * principal.asDiagonal() * axes.transpose());
  }

  static void place(BodyScenario& body, const MassSum& sum, const Mat3& wish) {
    const Mat3 axes = findPrincipalAxes(sum.inertia(), wish);
    body.mass = sum.mass();
    body.position = sum.centre();
    body.rotation = makeRotationVector(axes);
    body.inertia = (axes.transpose() * sum.inertia() * axes).diagonal();
  }

  void addPart(int geom, BodyScenario& body) const {
    const MujocoPose pose = poseOfGeom(world_, geom);
    const Mat3 to_body = makeRotation(body.rotation).conjugate().toRotationMatrix();
    PartScenario part;
    part.shape = makeShape(world_, geom, true);
    part.position = to_body * (pose.p_W - body.position);
    part.rotation = makeRotationVector(to_body * pose.R_W);
    body.parts.push_back(part);
  }

  /// A body without a form is a dot.
  static void simplify(BodyScenario& body) {
    if (body.parts.empty()) {
      body.shape.kind = "sphere";
      body.shape.radius = kDot;
    }
    joinOnlyPart(body);
  }

  void addJoint(int number) {
    const int type = model_.jnt_type[number], body = model_.jnt_bodyid[number];
    if (model_.body_jntnum[body] > 1)
      throw UsageError(fmt::format(
          "body \"{}\" has {} joints; give it one, and a small body for each other joint",
          nameOf(body), model_.body_jntnum[body]));
    if (type == mjJNT_FREE) return;
    JointScenario joint;
    joint.kind = type == mjJNT_BALL ? "ball" : type == mjJNT_SLIDE ? "slider" : "hinge";
    joint.bodies = {result_.names[nameOf(body)]};
    if (const int parent = model_.body_weldid[model_.body_parentid[body]]; parent != 0)
      joint.bodies.push_back(result_.names[nameOf(parent)]);
    joint.at = Vec3(world_.start->xanchor + 3 * number);
    joint.axis = Vec3(world_.start->xaxis + 3 * number);
    if (type != mjJNT_BALL) addLimits(number, joint);
    result_.joints.push_back(joint);
  }

  void addLimits(int number, JointScenario& joint) const {
    joint.friction = model_.dof_frictionloss[model_.jnt_dofadr[number]];
    if (model_.jnt_limited[number] == 0) return;
    const double start = world_.model->qpos0[model_.jnt_qposadr[number]];
    const double low = model_.jnt_range[2 * number] - start;
    const double high = model_.jnt_range[2 * number + 1] - start;
    // A hinge that may go round nearly once has no stop.
    if (joint.kind == "hinge" && std::max(-low, high) > 3.14) return;
    joint.limits = {low, high};
  }

  const MujocoModel& world_;
  const mjModel& model_;
  BodyNames names_;
  ImportedWorld result_;
};

}  // namespace

ImportedWorld importMujoco(const std::filesystem::path& file) {
  const std::string text = readImportFile(file);
  const auto import = [&] {
    try {
      const MujocoModel world = loadMujoco(file, text);
      return Importer(world).import();
    } catch (const UsageError& error) {
      throw UsageError(file.string() + ": " + error.what());
    }
  };
  tryInChild(file, "MuJoCo", [&] { (void)import(); });
  return import();
}

}  // namespace tandem::demos
