#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace tandem {

/// A rigid body of ours in a host's world. Many hosts finally delete all bodies of their world;
/// this class notices and does not delete the body twice.
class OwnBody {
 public:
  explicit OwnBody(const btRigidBody::btRigidBodyConstructionInfo& info)
      : rigid_(new Rigid(info, *this)) {}
  ~OwnBody() { delete rigid_; }
  OwnBody(const OwnBody&) = delete;
  OwnBody& operator=(const OwnBody&) = delete;

  [[nodiscard]] bool isAlive() const noexcept { return rigid_ != nullptr; }
  /// Valid only while the body is alive.
  [[nodiscard]] btRigidBody& rigid() const noexcept { return *rigid_; }

 private:
  class Rigid final : public btRigidBody {
   public:
    Rigid(const btRigidBodyConstructionInfo& info, OwnBody& owner)
        : btRigidBody(info), owner_(owner) {}
    ~Rigid() override { owner_.rigid_ = nullptr; }
    Rigid(const Rigid&) = delete;
    Rigid& operator=(const Rigid&) = delete;

   private:
    OwnBody& owner_;
  };

  Rigid* rigid_;
};

}  // namespace tandem
