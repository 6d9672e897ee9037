// The whole scene by Bullet's own means, at the host's rate. Tools are rigid bodies in Bullet's own
// contact, and their couplers are Bullet's own. The same classes carry whole demos (contact.model,
// docs/native.md). Tools have the gains of soft contact; Bullet's defaults stay.

#include "tandem/bullet_bridge/convert.h"

#include "bench/methods/all_methods.h"
#include "bench/methods/bullet_scene.h"
#include "bullet_bridge/src/native/native_coupling.h"

namespace tandem::demos::bench {
namespace {

enum class NativeContact { kRigid, kSoft };

class BulletNative final : public Simulation {
 public:
  BulletNative(const BenchScene& scene, int host_rate, NativeContact contact,
               NativeCouplerKind coupler)
      : scene_(scene), step_(1.0 / host_rate), bullet_(scene, {.tools_touch = true}) {
    for (std::size_t i = 0; i < scene.tools.size(); ++i) {
      if (contact == NativeContact::kSoft) setSoftContact(bullet_.tool(i), scene.contact);
      couplers_.push_back(
          scene.tools[i].device
              ? makeNativeCoupler(coupler, bullet_.world(), bullet_.tool(i), {scene.coupler, {}})
              : nullptr);
    }
  }

  void step() override {
    for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
      const BenchTool& tool = scene_.tools[i];
      bullet_.tool(i).applyCentralForce(toBullet(tool.f_W));
      const auto target = heldTarget(tool, steps_ * step_);
      if (target) couplers_[i]->pull({target->p_W, Quat::Identity(), target->v_W, {}}, step_);
    }
    bullet_.step(step_);
    ++steps_;
  }
  void read(SceneState& state) const override { bullet_.read(state); }

 private:
  const BenchScene& scene_;
  double step_;
  double steps_ = 0;
  BulletScene bullet_;
  std::vector<std::unique_ptr<NativeCoupler>> couplers_;
};

bool hasCoupler(const BenchScene& scene) {
  for (const BenchTool& tool : scene.tools)
    if (tool.device) return true;
  return false;
}

class BulletNativeMethod final : public Method {
 public:
  BulletNativeMethod(std::string name, NativeContact contact, NativeCouplerKind coupler)
      : name_(std::move(name)), contact_(contact), coupler_(coupler) {}
  std::string name() const override { return name_; }
  bool isBulletAlone() const override { return true; }

  std::unique_ptr<Simulation> start(const BenchScene& scene, int host_rate) const override {
    if (contact_ == NativeContact::kRigid && scene.bodies.empty())
      throw NotApplicable("there is no contact in this scene");
    if (coupler_ != NativeCouplerKind::kImpulse && !hasCoupler(scene))
      throw NotApplicable("there is no coupler in this scene");
    return std::make_unique<BulletNative>(scene, host_rate, contact_, coupler_);
  }

 private:
  std::string name_;
  NativeContact contact_;
  NativeCouplerKind coupler_;
};

}  // namespace

std::unique_ptr<Method> makeBulletRigid() {
  return std::make_unique<BulletNativeMethod>("Bullet rigid", NativeContact::kRigid,
                                              NativeCouplerKind::kImpulse);
}
std::unique_ptr<Method> makeBulletSoft() {
  return std::make_unique<BulletNativeMethod>("Bullet soft", NativeContact::kSoft,
                                              NativeCouplerKind::kImpulse);
}
std::unique_ptr<Method> makeBulletSpring6Dof() {
  return std::make_unique<BulletNativeMethod>("Bullet 6DofSpring2", NativeContact::kSoft,
                                              NativeCouplerKind::kSpring6Dof);
}
std::unique_ptr<Method> makeBulletPointToPoint() {
  return std::make_unique<BulletNativeMethod>("Bullet Point2Point", NativeContact::kSoft,
                                              NativeCouplerKind::kPointToPoint);
}

}  // namespace tandem::demos::bench
