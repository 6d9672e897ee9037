// ODE: couplers are forces at the start of each step. Tool contact is ODE's own compliant contact
// joint: ERP = h K / (h K + B), CFM = 1 / (h K + B). That is implicit Euler. Bodies use its rigid
// contact with friction (dWorldStep: the direct solver). Joints are its hinges and sliders. All
// else is the default of Debian's libode.

#include <array>

#include <ode/ode.h>

#include "bench/engines/engine_methods.h"
#include "bench/engines/tool_forces.h"

namespace tandem::demos::bench {
namespace {

Vec3 toVec3(const dReal* v) { return {v[0], v[1], v[2]}; }

/// ODE's global state, for the life of the process. Its messages on stderr are not part of a
/// benchmark: errors show in the states.
void initialiseOde() {
  static const bool done = [] {
    dInitODE2(0);
    dSetMessageHandler([](int, const char*, va_list) {});
    return true;
  }();
  static_cast<void>(done);
}

class OdeSimulation final : public Simulation {
 public:
  OdeSimulation(const BenchScene& scene, int host_rate) : scene_(scene), step_(1.0 / host_rate) {
    initialiseOde();
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    const Vec3& g_W = scene.gravity_W;
    dWorldSetGravity(world_, g_W.x(), g_W.y(), g_W.z());
    for (const BenchTool& tool : scene.tools) addTool(tool);
    for (const BenchBody& body : scene.bodies) addBody(body);
    for (const BenchJoint& joint : scene.joints) addJoint(joint);
  }
  ~OdeSimulation() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }
  OdeSimulation(const OdeSimulation&) = delete;
  OdeSimulation& operator=(const OdeSimulation&) = delete;

  void step() override {
    for (std::size_t i = 0; i < tools_.size(); ++i) {
      const Vec3 f_W =
          computeHandForce(scene_, scene_.tools[i], steps_ * step_, pointOf(tools_[i]));
      dBodyAddForce(tools_[i], f_W.x(), f_W.y(), f_W.z());
    }
    dSpaceCollide(space_, this, [](void* self, dGeomID a, dGeomID b) {
      static_cast<OdeSimulation*>(self)->meet(a, b);
    });
    dWorldStep(world_, step_);
    dJointGroupEmpty(contacts_);
    ++steps_;
  }

  void read(SceneState& state) const override {
    for (std::size_t i = 0; i < tools_.size(); ++i) state.tools[i] = pointOf(tools_[i]);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (!bodies_[b]) continue;
      const dReal* q = dBodyGetQuaternion(bodies_[b]);
      const PointState point = pointOf(bodies_[b]);
      state.bodies[b] = {point.p_W, Quat(q[0], q[1], q[2], q[3]), point.v_W,
                         toVec3(dBodyGetAngularVel(bodies_[b]))};
    }
  }

 private:
  static PointState pointOf(dBodyID body) {
    return {toVec3(dBodyGetPosition(body)), toVec3(dBodyGetLinearVel(body))};
  }

  dBodyID makeBody(double mass, const Vec3& inertia, const RigidState& start) {
    const dBodyID body = dBodyCreate(world_);
    dMass properties;
    dMassSetParameters(&properties, mass, 0, 0, 0, inertia.x(), inertia.y(), inertia.z(), 0, 0, 0);
    dBodySetMass(body, &properties);
    const Vec3 &p = start.p_W, &v = start.v_W, &w = start.w_W;
    const dQuaternion q = {start.q_WB.w(), start.q_WB.x(), start.q_WB.y(), start.q_WB.z()};
    dBodySetPosition(body, p.x(), p.y(), p.z());
    dBodySetQuaternion(body, q);
    dBodySetLinearVel(body, v.x(), v.y(), v.z());
    dBodySetAngularVel(body, w.x(), w.y(), w.z());
    return body;
  }

  void addTool(const BenchTool& tool) {
    RigidState start;
    start.p_W = tool.start.p_W;
    start.v_W = tool.start.v_W;
    const double inertia = 0.4 * tool.mass * tool.radius * tool.radius;
    const dBodyID body = makeBody(tool.mass, Vec3::Constant(inertia), start);
    dBodySetGravityMode(body, 0);
    dGeomSetBody(dCreateSphere(space_, tool.radius), body);
    // Distinguishes tools from bodies in a contact.
    dBodySetData(body, this);
    tools_.push_back(body);
  }

  void addBody(const BenchBody& body) {
    dGeomID geom = nullptr;
    if (const auto* box = std::get_if<BoxShape>(&body.shape)) {
      const Vec3 edges = 2.0 * box->half_extents;
      geom = dCreateBox(space_, edges.x(), edges.y(), edges.z());
    } else if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
      geom = dCreateSphere(space_, sphere->radius);
    } else {
      const Vec3& n = std::get<PlaneShape>(body.shape).normal_W;
      dCreatePlane(space_, n.x(), n.y(), n.z(), n.dot(body.start.p_W));
    }
    bodies_.push_back(body.isStatic() ? nullptr
                                      : makeBody(body.mass, computeInertia(body), body.start));
    if (bodies_.back()) {
      dGeomSetBody(geom, bodies_.back());
    } else if (geom) {
      const Quat& q = body.start.q_WB;
      const dQuaternion rotation = {q.w(), q.x(), q.y(), q.z()};
      dGeomSetPosition(geom, body.start.p_W.x(), body.start.p_W.y(), body.start.p_W.z());
      dGeomSetQuaternion(geom, rotation);
    }
  }

  void addJoint(const BenchJoint& joint) {
    const dBodyID a = bodies_[joint.a], b = joint.b ? bodies_[*joint.b] : nullptr;
    const Vec3& p_W = joint.pivot_W;
    const bool is_hinge = joint.kind == BenchJointKind::kHinge;
    const dJointID made =
        is_hinge ? dJointCreateHinge(world_, nullptr) : dJointCreateSlider(world_, nullptr);
    dJointAttach(made, a, b);
    const auto set = [&](int parameter, double value) {
      is_hinge ? dJointSetHingeParam(made, parameter, value)
               : dJointSetSliderParam(made, parameter, value);
    };
    if (is_hinge) {
      dJointSetHingeAnchor(made, p_W.x(), p_W.y(), p_W.z());
      dJointSetHingeAxis(made, 0, 1, 0);
    } else {
      dJointSetSliderAxis(made, joint.axis_W.x(), joint.axis_W.y(), joint.axis_W.z());
    }
    if (joint.limit) {
      set(dParamLoStop, joint.limit->low);
      set(dParamHiStop, joint.limit->high);
    }
    if (joint.motor) {
      set(dParamVel, joint.motor->speed);
      set(dParamFMax, joint.motor->force);
    }
  }

  static bool isTool(dBodyID body) { return body && dBodyGetData(body); }

  void meet(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (!body_a && !body_b) return;
    if (isTool(body_a) && isTool(body_b)) return;
    if (body_a && body_b && dAreConnectedExcluding(body_a, body_b, dJointTypeContact)) return;
    const bool is_soft = isTool(body_a) || isTool(body_b);
    std::array<dContactGeom, 8> points;
    const int count = dCollide(a, b, static_cast<int>(points.size()), points.data(),
                               static_cast<int>(sizeof(dContactGeom)));
    for (int i = 0; i < count; ++i) {
      dContact contact{};
      contact.geom = points[static_cast<std::size_t>(i)];
      if (is_soft) {
        soften(contact);
      } else {
        roughen(contact);
      }
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_a, body_b);
    }
  }

  void soften(dContact& contact) const {
    const double K = scene_.contact.stiffness, B = scene_.contact.damping;
    contact.surface.mode = dContactSoftERP | dContactSoftCFM;
    contact.surface.soft_erp = step_ * K / (step_ * K + B);
    contact.surface.soft_cfm = 1.0 / (step_ * K + B);
  }

  /// ODE's friction is a pyramid. Its first direction lies in the plane of the scenes' motion,
  /// where it equals Coulomb's cone.
  void roughen(dContact& contact) const {
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = scene_.friction;
    const Vec3 in_plane = Vec3::UnitY().cross(toVec3(contact.geom.normal));
    if (in_plane.norm() < 1e-6) return;
    contact.surface.mode |= dContactFDir1;
    const Vec3 direction = in_plane.normalized();
    for (int axis = 0; axis < 3; ++axis) contact.fdir1[axis] = direction[axis];
  }

  const BenchScene& scene_;
  double step_;
  double steps_ = 0;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> tools_, bodies_;  // null: static
};

class OdeMethod final : public Method {
 public:
  std::string name() const override { return "ODE"; }
  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    refuseBelts(scene);
    return std::make_unique<OdeSimulation>(scene, host_rate);
  }
};

}  // namespace

std::unique_ptr<Method> makeOde() { return std::make_unique<OdeMethod>(); }

}  // namespace tandem::demos::bench
