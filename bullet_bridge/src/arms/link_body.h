#pragma once

#include <string>
#include <vector>

#include "bodies/host_body.h"

class btCollisionObject;

#pragma GCC visibility push(default)
namespace tandem {

class HostArm;

/// A link of a multi-body of the host's, or its base: a body of the island. What it says of and to
/// Bullet goes through the arm, which handles all links at once.
class LinkBody final : public HostBody {
 public:
  LinkBody(HostArm& arm, std::size_t number) noexcept : arm_(arm), number_(number) {}

  [[nodiscard]] HostArm& arm() const noexcept { return arm_; }
  [[nodiscard]] std::size_t number() const noexcept { return number_; }  ///< in ArmModel::links()
  [[nodiscard]] double mass() const noexcept;                            ///< [kg]
  [[nodiscard]] Vec3 inertia() const noexcept;  ///< principal, in B [kg m^2]
  /// Null: a link without a shape.
  [[nodiscard]] btCollisionObject* collider() const noexcept;

  [[nodiscard]] bool isInWorld() const noexcept override;
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept override;
  [[nodiscard]] RigidState state() const noexcept override;
  [[nodiscard]] Vec3 gravityForce() const noexcept override;

  /// The result of HostArm::look().
  [[nodiscard]] HostChange takeHostChanges(double dt) noexcept override {
    HostChange change = change_;
    change.impulse_W += dt * change.f_W;
    change.angular_impulse_W += dt * change.t_W;
    return change;
  }
  /// For HostArm::handOff().
  void handOff(const RigidState& end, double, const Momentum& foreseen = {}) noexcept override {
    end_ = end;
    foreseen_ = foreseen;
  }
  /// The result of HostArm::restore().
  HostChange restore() noexcept override { return change_; }
  /// For HostArm::place().
  void place(const RigidState& state) noexcept override;
  void setState(const RigidState& state) noexcept override;

  /// Links never sleep while the island holds them.
  /// @{
  [[nodiscard]] bool standsAt(const RigidState&) const noexcept override { return false; }
  void park() noexcept override {}
  [[nodiscard]] bool isParked() const noexcept override { return false; }
  [[nodiscard]] bool isAsleep() const noexcept override { return false; }
  [[nodiscard]] bool isUndisturbed() const noexcept override { return false; }
  [[nodiscard]] bool hasMissedWorldGravity() const noexcept override { return false; }
  void unpark() noexcept override {}
  [[nodiscard]] bool wakeIfHit(HostChange&) noexcept override { return false; }
  /// @}

  void addMomentum(const Vec3& linear_W, const Vec3& angular_W) noexcept override;
  /// Nothing: with impulse injection the island holds no links.
  void applyWrench(const Vec3&, const Vec3&, double) noexcept override {}
  void remember() noexcept override;
  void shiftOrigin(const Vec3& offset_W) noexcept override;

 private:
  friend class HostArm;

  HostArm& arm_;
  std::size_t number_;
  RigidState end_;     ///< at the end of the step
  RigidState put_;     ///< of setState()
  Momentum foreseen_;  ///< mean over the step
  HostChange change_;
};

}  // namespace tandem
#pragma GCC visibility pop
