#pragma once

#include <utility>

#include "tandem/coordination/link.h"
#include "tandem/plugin/site_settings.h"

#include "coordination/src/island/island.h"
#include "site/objects.h"

namespace tandem {

// clang-format off
/// One hand's hold on one object: an IslandGrip over time.
///
///     begin        the object stays where it is; then it comes to the hand within `blend_time`
///     hold         weight that hangs on the spring becomes lift, within `lift_time`
///                  hand here: it feels the lift of its stand-ins elsewhere, too
///                  hand elsewhere: it feels the lift there, so its stand-in here does not
///     letGo        the pull fades within `fade_time`; then the two may touch again
///
/// For the thread that ticks; real-time safe.
// clang-format on
class GripHold {
 public:
  /// `hand`: the body that stands for the hand.
  GripHold(const SiteSettings& settings, Island& island, GripIndex index, BodyIndex hand) noexcept
      : settings_(&settings), island_(&island), index_(index), hand_(hand) {}

  /// True while it pulls, also while it fades.
  [[nodiscard]] bool isOn() const noexcept { return phase_ != Phase::kNone; }
  /// True until it is let go.
  [[nodiscard]] bool isHolding() const noexcept { return phase_ == Phase::kHolding; }
  /// What is held, and how; `epoch` and `age` are those told.
  [[nodiscard]] const GripState& state() const noexcept { return state_; }
  /// The same for a peer: the hand's frame is W's, so its orientation in B changes with the wrist.
  [[nodiscard]] GripState tell() const noexcept;
  [[nodiscard]] double share() const noexcept { return hold_.share; }
  [[nodiscard]] GripPull computePull() const noexcept { return island_->computeGripPull(index_); }

  /// Takes hold of an object as told; from the next follow() on it pulls. `told.age` [s] shortens
  /// the time in which the object comes to the hand.
  void begin(const GripState& told, const SharedObject& object) noexcept;
  /// Takes hold of an object by its place `at_B`, or where the hand is then, and as it is turned
  /// then.
  void begin(const SharedObject& object, const std::optional<Vec3>& at_B) noexcept;
  /// The hand turns: what it holds turns along. Before follow().
  void turn(const WristState& wrist) noexcept { wrist_ = wrist; }
  /// The same for a user elsewhere, with its newest state at its time `time` [s].
  void turn(const GripState& told, double time) noexcept;
  /// The user is silent: its hand is not known to turn.
  void stopTurning() noexcept { wrist_.w_W.setZero(); }
  /// Lets go: the pull fades.
  void letGo() noexcept;
  /// Lets go at once.
  void drop() noexcept;
  /// The hand is away: no pull, and it begins anew when it comes back.
  void pause() noexcept;

  /// Called once a tick of `period` [s], when the hand is at its place. `share` of all gains.
  /// `sites`: how many times the hand feels the lift of this copy.
  void follow(const SharedObject& object, double period, double share, double sites) noexcept;
  /// Takes the work of the load since the last call [J].
  [[nodiscard]] double takeWork() noexcept { return std::exchange(work_, 0.0); }
  /// How long the force has been at its limit [s].
  [[nodiscard]] double timeAtLimit() const noexcept { return at_limit_; }

 private:
  enum class Phase { kNone, kHolding, kFading };

  void find(const SharedObject& object) noexcept;
  void blend(double period) noexcept;
  void countWork(const RigidState& body) noexcept;
  void lift(const SharedObject& object, double period, double sites, bool is_limited) noexcept;
  [[nodiscard]] Vec3 findWay(const RigidState& body) const noexcept;
  [[nodiscard]] Quat findWanted() const noexcept;

  const SiteSettings* settings_;
  Island* island_;
  GripIndex index_;
  BodyIndex hand_;
  Phase phase_ = Phase::kNone;
  bool is_found_ = false;     ///< where the object was at the beginning is known
  bool finds_turn_ = false;   ///< it stays turned as it is found
  bool finds_place_ = false;  ///< it is held where the hand is found
  GripState state_;
  WristState wrist_;      ///< of the hand
  double told_at_ = 0.0;  ///< the user's time of `state_`, for a user elsewhere [s]
  IslandGrip hold_;
  Vec3 found_W_ = Vec3::Zero();                ///< offset at the beginning [m]
  Vec3 found_turn_W_ = Vec3::Zero();           ///< from the wanted orientation to the found one
  double blended_ = 0.0, blend_length_ = 0.0;  ///< [s]
  double lift_ = 0.0;                          ///< against the weight [N]
  Vec3 p_before_W_ = Vec3::Zero();             ///< place of the grip one tick ago
  double work_ = 0.0;                          ///< [J]
  double at_limit_ = 0.0, fade_left_ = 0.0;    ///< [s]
};

}  // namespace tandem
