// MuJoCo: couplers and tool contact are external forces (xfrc_applied) at the start of each step.
// The scene's own geometry gives the contact: MuJoCo's soft contact is scaled by both masses and
// has no K and B. Bodies use MuJoCo's own contact with an elliptic friction cone. Its time constant
// is two steps, as stiff as MuJoCo allows. Impedance is the default, as higher ones threw the
// stack's boxes about. The integrator is its default, semi-implicit Euler.

#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "bench/engines/engine_methods.h"
#include "bench/engines/tool_forces.h"

namespace tandem::demos::bench {
namespace {

std::string show(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
std::string show(const Quat& q) { return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z()); }
Vec3 toVec3(const mjtNum* v) { return {v[0], v[1], v[2]}; }

std::string describeGeom(const BenchBody& body) {
  if (const auto* box = std::get_if<BoxShape>(&body.shape))
    return fmt::format("type='box' size='{}'", show(box->half_extents));
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape))
    return fmt::format("type='sphere' size='{}'", sphere->radius);
  // Size 0 means infinite.
  return fmt::format("type='plane' size='0 0 1' zaxis='{}'",
                     show(std::get<PlaneShape>(body.shape).normal_W));
}

std::string describeTool(const BenchTool& tool, std::size_t i) {
  const double inertia = 0.4 * tool.mass * tool.radius * tool.radius;
  std::string text = fmt::format(
      "<body name='tool{0}' pos='{1}'><inertial pos='0 0 0' mass='{2}' "
      "diaginertia='{3} {3} {3}'/>",
      i, show(tool.start.p_W), tool.mass, inertia);
  for (const char* axis : {"1 0 0", "0 1 0", "0 0 1"})
    text += fmt::format("<joint type='slide' axis='{}'/>", axis);
  return text + "</body>\n";
}

std::string describeBody(const BenchBody& body, std::size_t b) {
  const bool is_plane = std::holds_alternative<PlaneShape>(body.shape);
  const std::string pose =
      is_plane ? fmt::format("pos='{}'", show(body.start.p_W))
               : fmt::format("pos='{}' quat='{}'", show(body.start.p_W), show(body.start.q_WB));
  if (body.isStatic()) return fmt::format("<geom {} {}/>\n", describeGeom(body), pose);
  return fmt::format(
      "<body name='body{}' {}><freejoint/><inertial pos='0 0 0' mass='{}' diaginertia='{}'/>"
      "<geom {}/></body>\n",
      b, pose, body.mass, show(computeInertia(body)), describeGeom(body));
}

std::string describe(const BenchScene& scene, double step) {
  std::string text = fmt::format(
      "<mujoco><size njmax='2000' nconmax='500'/>"
      "<option timestep='{}' gravity='{}' cone='elliptic' tolerance='1e-10'/>"
      "<default><geom friction='{} 0 0' condim='{}' solref='{} 1'/>"
      "</default><worldbody>\n",
      step, show(scene.gravity_W), scene.friction, scene.friction > 0.0 ? 3 : 1, 2.0 * step);
  for (std::size_t i = 0; i < scene.tools.size(); ++i) text += describeTool(scene.tools[i], i);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) text += describeBody(scene.bodies[b], b);
  return text + "</worldbody></mujoco>\n";
}

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, ModelDeleter>;
using DataPointer = std::unique_ptr<mjData, ModelDeleter>;

/// MuJoCo reads its models from files, which may be in memory only.
ModelPointer load(const std::string& text) {
  // MuJoCo would write its warnings to a file in the working folder. The same facts are in mjData.
  mju_user_warning = [](const char*) {};
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const int size = static_cast<int>(text.size());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", size);
  std::memcpy(files->filedata[0], text.data(), text.size());
  char error[1000] = "";
  ModelPointer model(mj_loadXML("scene.xml", files.get(), error, sizeof(error)));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(fmt::format("MuJoCo: {}", error));
  return model;
}

class MujocoSimulation final : public Simulation {
 public:
  MujocoSimulation(const BenchScene& scene, int host_rate)
      : scene_(scene),
        model_(load(describe(scene, 1.0 / host_rate))),
        data_(mj_makeData(model_.get())),
        state_(startState(scene)) {
    for (std::size_t i = 0; i < scene.tools.size(); ++i) {
      tools_.push_back(findBody(fmt::format("tool{}", i)));
      setVelocity(tools_.back(), 0, scene.tools[i].start.v_W);
    }
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      const BenchBody& body = scene.bodies[b];
      bodies_.push_back(body.isStatic() ? 0 : findBody(fmt::format("body{}", b)));
      if (body.isStatic()) continue;
      setVelocity(bodies_.back(), 0, body.start.v_W);
      // A free joint's angular velocity is in the body's own frame.
      setVelocity(bodies_.back(), 3, body.start.q_WB.conjugate() * body.start.w_W);
    }
  }

  void step() override {
    read(state_);
    mju_zero(data_->xfrc_applied, 6 * model_->nbody);
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      const BenchTool& tool = scene_.tools[i];
      const double now = steps_ * model_->opt.timestep;
      Vec3 f_W = computeHandForce(scene_, tool, now, state_.tools[i]);
      f_W -= tool.mass * scene_.gravity_W;  // MuJoCo's gravity pulls all bodies
      f_W += computeContactForces(scene_, state_, i,
                                  [&](std::size_t b, const Vec3& reaction_W, const Vec3& p_W) {
                                    const Vec3 t_W = (p_W - state_.bodies[b].p_W).cross(reaction_W);
                                    push(bodies_[b], reaction_W, t_W);
                                  });
      push(tools_[i], f_W, Vec3::Zero());
    }
    mj_step(model_.get(), data_.get());
    ++steps_;
  }

  void read(SceneState& state) const override {
    for (std::size_t i = 0; i < tools_.size(); ++i)
      state.tools[i] = {scene_.tools[i].start.p_W + toVec3(position(tools_[i])),
                        toVec3(velocity(tools_[i]))};
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (scene_.bodies[b].isStatic()) continue;
      const mjtNum *q = position(bodies_[b]), *v = velocity(bodies_[b]);
      const Quat q_WB = Quat(q[3], q[4], q[5], q[6]).normalized();
      state.bodies[b] = {toVec3(q), q_WB, toVec3(v), q_WB * toVec3(v + 3)};
    }
    if (isLost()) loseAll(state);
  }

 private:
  int findBody(const std::string& name) const {
    return mj_name2id(model_.get(), mjOBJ_BODY, name.c_str());
  }
  int firstJoint(int body) const { return model_->body_jntadr[body]; }
  mjtNum* position(int body) const { return data_->qpos + model_->jnt_qposadr[firstJoint(body)]; }
  mjtNum* velocity(int body) const { return data_->qvel + model_->jnt_dofadr[firstJoint(body)]; }
  void setVelocity(int body, int first, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) velocity(body)[first + axis] = v[axis];
  }
  void push(int body, const Vec3& f_W, const Vec3& t_W) {
    mjtNum* applied = data_->xfrc_applied + 6 * body;
    for (int axis = 0; axis < 3; ++axis) {
      applied[axis] += f_W[axis];
      applied[axis + 3] += t_W[axis];
    }
  }

  /// MuJoCo restarts with a warning when its numbers exceed 1e10.
  [[nodiscard]] bool isLost() const {
    for (const int warning : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})
      if (data_->warning[warning].number > 0) return true;
    return false;
  }
  static void loseAll(SceneState& state) {
    const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    for (PointState& tool : state.tools) tool.p_W = nowhere;
    for (RigidState& body : state.bodies) body.p_W = nowhere;
  }

  const BenchScene& scene_;
  ModelPointer model_;
  DataPointer data_;
  SceneState state_;
  std::vector<int> tools_, bodies_;
  double steps_ = 0;
};

class MujocoMethod final : public Method {
 public:
  std::string name() const override { return "MuJoCo"; }
  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    refuseBelts(scene);
    refuseJoints(scene);
    return std::make_unique<MujocoSimulation>(scene, host_rate);
  }
};

}  // namespace

std::unique_ptr<Method> makeMujoco() { return std::make_unique<MujocoMethod>(); }

}  // namespace tandem::demos::bench
