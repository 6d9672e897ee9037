#pragma once

#include <vector>

#include "bullet_bridge/src/native/support_rows.h"
#include "site/surroundings.h"

namespace tandem {

// clang-format off
/// Shows Bullet what holds up the bodies that strangers press (SupportRows): moving objects of the
/// host that the island does not hold, and joints.
///
///     host's thread      show | Bullet's step | takeOut, finish ... look
///     thread that ticks  findContacts before
// clang-format on
class Press {
 public:
  Press(btDiscreteDynamicsWorld& world, Island& island, Timeline& timeline, Bodies& bodies,
        Surroundings& surroundings)
      : island_(island),
        timeline_(timeline),
        bodies_(bodies),
        surroundings_(surroundings),
        rows_(world) {}

  /// Finds the contacts at the end of the host's step, if something may press. In the thread that
  /// ticks; real-time safe.
  void findContacts(double step_end) noexcept;
  /// Pre-tick, after hand-off for a step of `dt` [s].
  void show(double dt);
  /// Post-tick. Hides the supports from the host again.
  void takeOut() noexcept { rows_.takeOut(); }
  /// Post-tick, when all changes by Bullet's solver are known. Improves those of pressed bodies.
  void finish(double dt) noexcept { rows_.finish(dt); }
  /// Momentum that Bullet's view of supports gave to a body in the last step. The island has these.
  [[nodiscard]] SupportRows::Given computeSupport(const SiteBody& body) const noexcept {
    const HapticBody* rigid = body.bullet->asRigid();
    return rigid ? rows_.computeGiven(*rigid) : SupportRows::Given{};
  }
  /// Post-tick, after the search. Notes which bodies may be pressed in the next step of `dt` [s].
  void look(double dt);
  /// Allocates.
  void makeRoom();

 private:
  void spread() noexcept;
  [[nodiscard]] bool isPressed(BodyIndex body) const noexcept {
    return body != kStanding && pressed_[static_cast<std::size_t>(body)];
  }

  Island& island_;
  Timeline& timeline_;
  Bodies& bodies_;
  Surroundings& surroundings_;
  SupportRows rows_;
  std::vector<char> pressed_;           ///< by body
  std::vector<SupportBody> held_;       ///< by body; null: Bullet's solver does not move it
  std::vector<char> led_;               ///< by body: kinematic and moving
  std::vector<RigidContact> contacts_;  ///< at the end of the host's step
  std::vector<RigidState> states_;      ///< at that time
  bool is_any_pressed_ = false;
};

}  // namespace tandem
