// Simbody: couplers and tool contact are one Force::Custom with the scene's own laws and geometry.
// Its integrator evaluates it at every stage: Runge-Kutta-Merson (order 4), one fixed step per host
// step, events not located. Its own compliant contact (Hunt and Crossley) is another law. Its rigid
// contact supports listed points, edges and spheres only, no boxes.

#include <limits>

#include <Simbody.h>

#include "bench/engines/engine_methods.h"
#include "bench/engines/tool_forces.h"

namespace tandem::demos::bench {
namespace {

SimTK::Vec3 toSimbody(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 fromSimbody(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

/// The scene's moving bodies in Simbody.
struct Bodies {
  std::vector<SimTK::MobilizedBody> tools, bodies;  // static ones: Ground

  void read(const BenchScene& scene, const SimTK::State& from, SceneState& state) const {
    for (std::size_t i = 0; i < tools.size(); ++i)
      state.tools[i] = {fromSimbody(tools[i].getBodyOriginLocation(from)),
                        fromSimbody(tools[i].getBodyOriginVelocity(from))};
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (scene.bodies[b].isStatic()) continue;
      const SimTK::Quaternion q = bodies[b].getBodyRotation(from).convertRotationToQuaternion();
      state.bodies[b] = {fromSimbody(bodies[b].getBodyOriginLocation(from)),
                         Quat(q[0], q[1], q[2], q[3]),
                         fromSimbody(bodies[b].getBodyOriginVelocity(from)),
                         fromSimbody(bodies[b].getBodyAngularVelocity(from))};
    }
  }
};

/// All forces: weight of bodies, couplers and contacts of tools.
class SceneForces final : public SimTK::Force::Custom::Implementation {
 public:
  SceneForces(const BenchScene& scene, const Bodies& bodies, const double& target_time)
      : scene_(scene), bodies_(bodies), target_time_(target_time), state_(startState(scene)) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector&) const override {
    bodies_.read(scene_, state, state_);
    for (std::size_t b = 0; b < bodies_.bodies.size(); ++b)
      if (!scene_.bodies[b].isStatic())
        push(bodies_.bodies[b], scene_.bodies[b].mass * scene_.gravity_W, Vec3::Zero(),
             body_forces);
    for (std::size_t i = 0; i < bodies_.tools.size(); ++i) {
      Vec3 f_W = computeHandForce(scene_, scene_.tools[i], target_time_, state_.tools[i]);
      f_W += computeContactForces(scene_, state_, i,
                                  [&](std::size_t b, const Vec3& reaction_W, const Vec3& p_W) {
                                    const Vec3 t_W = (p_W - state_.bodies[b].p_W).cross(reaction_W);
                                    push(bodies_.bodies[b], reaction_W, t_W, body_forces);
                                  });
      push(bodies_.tools[i], f_W, Vec3::Zero(), body_forces);
    }
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  static void push(const SimTK::MobilizedBody& body, const Vec3& f_W, const Vec3& t_W,
                   SimTK::Vector_<SimTK::SpatialVec>& body_forces) {
    body_forces[body.getMobilizedBodyIndex()] += SimTK::SpatialVec(toSimbody(t_W), toSimbody(f_W));
  }

  const BenchScene& scene_;
  const Bodies& bodies_;
  const double& target_time_;
  mutable SceneState state_;
};

class SimbodySimulation final : public Simulation {
 public:
  SimbodySimulation(const BenchScene& scene, int host_rate)
      : scene_(scene),
        step_(1.0 / host_rate),
        matter_(system_),
        forces_(system_),
        integrator_(system_),
        state_(startState(scene)) {
    addBodies();
    // Simbody owns the object from here on.
    SimTK::Force::Custom(forces_, new SceneForces(scene_, bodies_, target_time_));
    SimTK::State start = system_.realizeTopology();
    setStart(start);
    integrator_.setFixedStepSize(step_);
    integrator_.setAllowInterpolation(false);
    integrator_.initialize(start);
  }

  void step() override {
    if (is_lost_) return;
    target_time_ = steps_ * step_;
    ++steps_;
    try {
      // The target is no part of Simbody's state: values computed with the old one are discarded.
      integrator_.updAdvancedState().invalidateAll(SimTK::Stage::Dynamics);
      integrator_.reinitialize(SimTK::Stage::Dynamics, false);
      // The first call after a change of the state only reports its start.
      const double end = steps_ * step_;
      while (integrator_.getTime() < end) integrator_.stepTo(end, end);
    } catch (const std::exception&) {
      is_lost_ = true;  // numbers beyond the range of its integrator
    }
  }

  void read(SceneState& state) const override {
    if (!is_lost_) {
      const SimTK::State& now = integrator_.getState();
      system_.realize(now, SimTK::Stage::Velocity);
      bodies_.read(scene_, now, state);
      return;
    }
    const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    for (PointState& tool : state.tools) tool.p_W = nowhere;
    for (RigidState& body : state.bodies) body.p_W = nowhere;
  }

 private:
  void addBodies() {
    const SimTK::Vec3 centre(0);
    for (const BenchTool& tool : scene_.tools) {
      const double inertia = 0.4 * tool.mass * tool.radius * tool.radius;
      const SimTK::Body::Rigid body({tool.mass, centre, SimTK::Inertia(inertia)});
      bodies_.tools.push_back(SimTK::MobilizedBody::Translation(matter_.Ground(), body));
    }
    for (const BenchBody& body : scene_.bodies) {
      if (body.isStatic()) {
        bodies_.bodies.push_back(matter_.Ground());
        continue;
      }
      const SimTK::Body::Rigid rigid(
          {body.mass, centre, SimTK::Inertia(toSimbody(computeInertia(body)))});
      bodies_.bodies.push_back(SimTK::MobilizedBody::Free(matter_.Ground(), rigid));
    }
  }

  void setStart(SimTK::State& start) const {
    for (std::size_t i = 0; i < bodies_.tools.size(); ++i) {
      bodies_.tools[i].setQToFitTranslation(start, toSimbody(scene_.tools[i].start.p_W));
      bodies_.tools[i].setUToFitLinearVelocity(start, toSimbody(scene_.tools[i].start.v_W));
    }
    for (std::size_t b = 0; b < bodies_.bodies.size(); ++b) {
      const BenchBody& body = scene_.bodies[b];
      if (body.isStatic()) continue;
      const Quat& q = body.start.q_WB;
      const SimTK::Rotation rotation(SimTK::Quaternion(q.w(), q.x(), q.y(), q.z()));
      bodies_.bodies[b].setQToFitTransform(start, {rotation, toSimbody(body.start.p_W)});
      bodies_.bodies[b].setUToFitVelocity(
          start, SimTK::SpatialVec(toSimbody(body.start.w_W), toSimbody(body.start.v_W)));
    }
  }

  const BenchScene& scene_;
  double step_;
  double steps_ = 0;
  double target_time_ = 0.0;
  bool is_lost_ = false;
  Bodies bodies_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::RungeKuttaMersonIntegrator integrator_;
  SceneState state_;
};

class SimbodyMethod final : public Method {
 public:
  std::string name() const override { return "Simbody"; }
  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    refuseJoints(scene);
    if (!scene.is_smooth)
      throw NotApplicable("Simbody has no rigid contact of boxes, only of listed points and edges");
    return std::make_unique<SimbodySimulation>(scene, host_rate);
  }
};

}  // namespace

std::unique_ptr<Method> makeSimbody() { return std::make_unique<SimbodyMethod>(); }

}  // namespace tandem::demos::bench
