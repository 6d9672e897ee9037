#include "reference/rigid_reference.h"

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "bench/reference/sampling.h"

namespace tandem::reference {
namespace {

Vec3 springDamperForce(const SpringDamper& gains, const Vec3& offset, const Vec3& velocity) {
  return gains.stiffness * offset + gains.damping * velocity;
}

struct BoxLoad {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();  // torque about the centre, in W
};

// Sums the forces on each body; keeps its storage between evaluations.
class Loads {
 public:
  explicit Loads(const RigidScene& scene)
      : spheres_(scene.spheres.size()), boxes_(scene.boxes.size()) {}

  void compute(const RigidScene& scene) {
    addOwnLoads(scene);
    addContacts(scene);
  }

  [[nodiscard]] const Vec3& onSphere(std::size_t sphere) const { return spheres_[sphere]; }
  [[nodiscard]] const BoxLoad& onBox(std::size_t box) const { return boxes_[box]; }

 private:
  void addOwnLoads(const RigidScene& scene) {
    for (std::size_t i = 0; i < spheres_.size(); ++i) {
      const Sphere& sphere = scene.spheres[i];
      spheres_[i] = sphere.force + sphere.mass * scene.gravity - sphere.damping * sphere.v +
                    springDamperForce(sphere.coupling, sphere.target_p - sphere.p,
                                      sphere.target_v - sphere.v);
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Box& box = scene.boxes[i];
      boxes_[i].force = box.force + box.mass * scene.gravity - box.damping * box.v +
                        springDamperForce(box.coupling, box.target_p - box.p, box.target_v - box.v);
      boxes_[i].torque = box.torque + springDamperForce(box.angular_coupling,
                                                        computeRotationVector(box.q, box.target_q),
                                                        box.target_w - box.w);
    }
  }

  void addContacts(const RigidScene& scene) {
    findTouches(scene, touches_);
    for (const Touch& touch : touches_) {
      pushSphere(scene, touch.sphere, touch.force);
      if (touch.other_is_box) {
        BoxLoad& box = boxes_[touch.other];
        box.force -= touch.force;
        box.torque -= (touch.contact.point - scene.boxes[touch.other].p).cross(touch.force);
      } else {
        pushSphere(scene, touch.other, -touch.force);
      }
    }
  }

  void pushSphere(const RigidScene& scene, std::size_t sphere, const Vec3& force) {
    if (scene.spheres[sphere].motion == Motion::kDynamic) spheres_[sphere] += force;
  }

  std::vector<Vec3> spheres_;
  std::vector<BoxLoad> boxes_;
  std::vector<Touch> touches_;
};

// The scene as one vector of numbers for the integrator. Per sphere: p, v. Per box: p, v, q (x, y,
// z, w), angular momentum in W.
constexpr Eigen::Index kSphereNumbers = 6;
constexpr Eigen::Index kBoxNumbers = 13;

class SceneIntegrator {
 public:
  explicit SceneIntegrator(RigidScene& scene) : scene_(scene), loads_(scene) {
    const auto size = static_cast<Eigen::Index>(scene.spheres.size()) * kSphereNumbers +
                      static_cast<Eigen::Index>(scene.boxes.size()) * kBoxNumbers;
    for (Eigen::VectorXd* numbers : {&y_, &stage_, &slope_, &sum_})
      *numbers = Eigen::VectorXd(size);
    pack();
  }

  void advanceStep(double step) {
    computeSlope(y_);
    sum_ = slope_;
    stage_ = y_ + step / 2.0 * slope_;
    computeSlope(stage_);
    sum_ += 2.0 * slope_;
    stage_ = y_ + step / 2.0 * slope_;
    computeSlope(stage_);
    sum_ += 2.0 * slope_;
    stage_ = y_ + step * slope_;
    computeSlope(stage_);
    y_ += step / 6.0 * (sum_ + slope_);
  }

  // Stores the state in the scene.
  void finish() { unpack(y_); }

 private:
  void pack() {
    Eigen::Index i = 0;
    for (const Sphere& sphere : scene_.spheres) {
      y_.segment<6>(i) << sphere.p, sphere.v;
      i += kSphereNumbers;
    }
    for (const Box& box : scene_.boxes) {
      y_.segment<13>(i) << box.p, box.v, box.q.coeffs(), computeSpin(box);
      i += kBoxNumbers;
    }
  }

  void unpack(const Eigen::VectorXd& y) {
    Eigen::Index i = 0;
    for (Sphere& sphere : scene_.spheres) {
      sphere.p = y.segment<3>(i);
      sphere.v = y.segment<3>(i + 3);
      i += kSphereNumbers;
    }
    for (Box& box : scene_.boxes) {
      box.p = y.segment<3>(i);
      box.v = y.segment<3>(i + 3);
      box.q.coeffs() = y.segment<4>(i + 6).normalized();
      const Vec3 spin_B = box.q.conjugate() * Vec3(y.segment<3>(i + 10));
      box.w = box.q * spin_B.cwiseQuotient(box.inertia);
      i += kBoxNumbers;
    }
  }

  void computeSlope(const Eigen::VectorXd& y) {
    unpack(y);
    loads_.compute(scene_);
    Eigen::Index i = 0;
    for (std::size_t s = 0; s < scene_.spheres.size(); ++s) {
      const Sphere& sphere = scene_.spheres[s];
      slope_.segment<3>(i) = sphere.v;
      slope_.segment<3>(i + 3).setZero();
      if (sphere.motion != Motion::kPrescribed) {
        slope_.segment<3>(i + 3) = loads_.onSphere(s) / sphere.mass;
      }
      i += kSphereNumbers;
    }
    for (std::size_t b = 0; b < scene_.boxes.size(); ++b) {
      const Box& box = scene_.boxes[b];
      const Quat turn = Quat(0.0, box.w.x(), box.w.y(), box.w.z()) * box.q;  // q' = w q / 2
      slope_.segment<3>(i) = box.v;
      slope_.segment<3>(i + 3) = loads_.onBox(b).force / box.mass;
      slope_.segment<4>(i + 6) = 0.5 * turn.coeffs();
      slope_.segment<3>(i + 10) = loads_.onBox(b).torque;
      i += kBoxNumbers;
    }
  }

  RigidScene& scene_;
  Loads loads_;
  Eigen::VectorXd y_;
  Eigen::VectorXd stage_;
  Eigen::VectorXd slope_;
  Eigen::VectorXd sum_;
};

void requirePhysical(const RigidScene& scene) {
  for (const Sphere& sphere : scene.spheres) {
    if (!(sphere.mass > 0.0)) throw std::invalid_argument("advanceScene: sphere without mass");
  }
  for (const Box& box : scene.boxes) {
    if (!(box.mass > 0.0) || !(box.inertia.minCoeff() > 0.0)) {
      throw std::invalid_argument("advanceScene: box without mass or inertia");
    }
  }
}

}  // namespace

void advanceScene(RigidScene& scene, double duration, double max_step) {
  if (!(max_step > 0.0)) throw std::invalid_argument("advanceScene: max_step must be positive");
  requirePhysical(scene);
  const int steps = countSteps(duration, max_step);
  SceneIntegrator integrator(scene);
  for (int i = 0; i < steps; ++i) integrator.advanceStep(duration / steps);
  integrator.finish();
}

}  // namespace tandem::reference
