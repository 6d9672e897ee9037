#pragma once

#include <vector>

#include <LinearMath/btTransform.h>

class btDiscreteDynamicsWorld;
class btRigidBody;
class btTypedConstraint;

#pragma GCC visibility push(default)
namespace tandem {

/// Joints whose frames the host moves while its world runs, as a mouse does that drags a body by
/// btPoint2PointConstraint::setPivotB(). Bullet pulls the body along with its own error reduction,
/// and the island leaves joint and bodies to it until the frames have stood for half a second.
///
/// A static body that the host moves carries its joints' frames along. For the thread that steps
/// the host's world.
class MovedFrames {
 public:
  explicit MovedFrames(btDiscreteDynamicsWorld& host) : host_(host) {}

  /// Reads the frames of all joints, once before a host step of `dt` [s]. May allocate.
  void look(double dt);
  /// True if the joint's frames have moved in the last half second. Compares addresses only.
  [[nodiscard]] bool isMoving(const btTypedConstraint& joint) const noexcept;
  /// True if such a joint drags the body. Compares addresses only.
  [[nodiscard]] bool isDragged(const btRigidBody& body) const noexcept;
  /// The host's world ends, or all of it has been moved.
  void forget() noexcept { joints_.clear(), moving_.clear(); }

 private:
  struct Frames {
    btTransform a, b;  ///< in the bodies, or in W on a body that stands
  };
  struct Known {
    const btTypedConstraint* joint;
    Frames frames;
    double time_left;  ///< until it counts as standing [s]
  };
  /// Addresses only.
  struct Moving {
    const btTypedConstraint* joint;
    const btRigidBody *a, *b;  ///< null: forces do not move it
  };

  [[nodiscard]] static bool read(btTypedConstraint& joint, Frames& frames) noexcept;
  [[nodiscard]] const Known* find(const btTypedConstraint* joint, std::size_t hint) const noexcept;

  btDiscreteDynamicsWorld& host_;
  std::vector<Known> joints_, next_;  ///< in the order of the world
  std::vector<Moving> moving_;
};

}  // namespace tandem
#pragma GCC visibility pop
